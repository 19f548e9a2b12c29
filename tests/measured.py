"""The measured records of paper on paper, which the project does not contain."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import stiction as st

FOLDER = Path(__file__).parents[2] / "shared" / "data" / "paper-friction"
MASS, GRAVITY = 0.0307, 9.81  # kg, m/s^2; from the data's README


def read_measured(name: str) -> st.Record:
    """Return a record with what is known of its rig; skip the test where the data are absent."""
    path = FOLDER / f"{name}.csv.gz"
    if not path.is_file():
        pytest.skip(f"no {path.name} beside the repository")
    time, ratio = np.loadtxt(path, delimiter=",", skiprows=1, unpack=True)
    stiffness, velocity = name[1:].split("_v")
    return st.Record(
        time=time,
        force=ratio * MASS * GRAVITY,
        normal_load=MASS * GRAVITY,
        mass=MASS,
        stiffness=float(stiffness),
        drive_velocity=1e-6 * float(velocity),
    )


def bare(record: st.Record) -> st.Record:
    """Return a record of which nothing but time and force is known."""
    return st.Record(time=record.time, force=record.force)
