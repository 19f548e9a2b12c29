"""Measures of one's own: functions from a run to a number."""

from typing import Annotated

import numpy as np

import stiction as st


def friction_heat(run: st.Trajectory) -> Annotated[float, "W"]:
    """Mean power that friction turns into heat."""
    return np.mean(run.samples["friction"] * run.samples["slip_speed"])


def longest_stick(run: st.Trajectory) -> Annotated[float, "s"]:
    """Duration of the longest stick."""
    return run.sticks["stick_duration"].max()
