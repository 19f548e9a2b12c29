"""A friction test: friction over time, and stretches of constant velocity."""

from __future__ import annotations

from math import nan
from typing import NamedTuple

import numpy as np

from stiction.analysis.record import Record, as_record
from stiction.arrays import Floats, Indices
from stiction.drive import ConstantVelocity, DriveProgram, drive_stretches
from stiction.errors import ResultError
from stiction.trajectory import Trajectory

SETTLED = 0.2  # of a stretch: its end, in which friction counts as steady


class ConstantStretch(NamedTuple):
    """An interval of constant drive velocity.

    Attributes
    ----------
    start, end : float
        s.
    velocity : float
        Of the drive along X, m/s.
    """

    start: float
    end: float
    velocity: float


class FrictionTest(NamedTuple):
    """Friction over time, and what the drive does meanwhile.

    Attributes
    ----------
    time : ndarray
        (n,), s.
    mu : ndarray
        (n,), force along the drive over normal load.
    lag : ndarray
        (n,), elongation of the spring along the drive, m; zero where the stiffness is unknown.
    load : float
        Mean normal load, N.
    stiffness : float
        Of the soft spring, N/m; NaN if unknown.
    stretches : list of ConstantStretch
        In order of time.
    """

    time: Floats
    mu: Floats
    lag: Floats
    load: float
    stiffness: float
    stretches: list[ConstantStretch]

    def within(self, start: float, end: float) -> Indices:
        """Return the indices of the samples from `start` to `end` (s)."""
        first, after = np.searchsorted(self.time, [start - 1e-9, end + 1e-9])
        return np.arange(first, after)

    def steady(self, stretch: ConstantStretch) -> float:
        """Return the mean friction in the end of a stretch, NaN without samples."""
        near = self.within(stretch.end - SETTLED * (stretch.end - stretch.start), stretch.end)
        return float(self.mu[near].mean()) if len(near) else nan


def friction_test(source: Trajectory | Record, program: DriveProgram | None = None) -> FrictionTest:
    """Return a run, or a record of a test by a program, as a friction test.

    Parameters
    ----------
    source : Trajectory or Record
        A record needs its normal load.
    program : DriveProgram, optional
        The program by which a record was taken, with t = 0 as in its time; that of the run is
        known.

    Raises
    ------
    ResultError
        If the program or the load is unknown.
    """
    if isinstance(source, Trajectory):
        d, slider = source.samples, source.slider
        load = np.asarray(d["normal_load"], dtype=np.float64)
        force = slider.along_drive(d["spring_x"], d["spring_y"])
        lag = slider.along_drive(d["u_x"], d["u_y"])
        time, drive = d["time"], slider.motion
        mean, k_x = float(load.mean()), slider.k_x
        return FrictionTest(time, force / load, lag, mean, k_x, stretches(drive, time))
    source = as_record(source)
    if source.normal_load is None:
        raise ResultError("friction needs the normal load; give the record its normal_load")
    if program is None:
        raise ResultError(
            "the drive of a record is unknown; give its program, such as "
            "st.protocols.velocity_steps(...)"
        )
    lag = source.force / source.stiffness if source.stiffness else np.zeros(len(source.time))
    mu = source.force / source.normal_load / source.relative_load()
    k = source.stiffness or nan
    return FrictionTest(
        source.time, mu, lag, source.normal_load, k, stretches(program, source.time)
    )


def stretches(drive: ConstantVelocity | DriveProgram, time: Floats) -> list[ConstantStretch]:
    """Return the stretches of a drive's velocity while it is recorded; harmonics are left out."""
    first, last = float(time[0]), float(time[-1])
    found: list[ConstantStretch] = []
    start = 0.0
    for end, _ in drive_stretches(drive):
        begin, until = max(start, first), min(end, last)
        if until > begin:
            velocity = float(drive.rate(0.5 * (begin + until))[0])
            if found and found[-1].velocity == velocity:
                found[-1] = found[-1]._replace(end=until)
            else:
                found.append(ConstantStretch(begin, until, velocity))
        start = end
    return found
