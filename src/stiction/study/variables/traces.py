"""Traces: time series that a study can keep of each run."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.study.variables.observation import Observed


class Trace(NamedTuple):
    """A time series: its CF attributes, and a function that returns its even samples."""

    unit: str
    long_name: str
    of: Callable[[Observed], NDArray[np.float64]]


TRACES: dict[str, Trace] = {
    "force": Trace("N", "spring force along x, k_x u_x", lambda run: run.force),
    "velocity": Trace("m/s", "velocity of the mass along X", lambda run: run.velocity),
    "position": Trace("m", "position of the mass along X", lambda run: run.positions),
}
