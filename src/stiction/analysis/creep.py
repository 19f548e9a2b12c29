"""The slow motion before slip, as a run shows it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    import xarray as xr


def first_slip_time(run: Trajectory) -> float:
    """Return when the mass first moves faster along X than the drive does (s).

    Creep is slower than the drive, rapid slip faster. If it never happens, the run's last time.
    """
    times, drive = run.data["time"].values, run.data["drive_X"].values
    faster = np.flatnonzero(run.data["V_X"].values * np.sign(drive) > np.abs(drive))
    return float(times[faster[0]] if len(faster) else times[-1])


def mean_creep_velocity(run: Trajectory, width: float = 0.02) -> xr.DataArray:
    """Return the velocity X' (m/s) averaged over the transverse oscillation, before the first slip.

    The oscillation makes the creep advance in steps, about one each transverse period with a
    rest in between. An average over whole steps, from one rest to another, is free of them: it
    is the distance covered divided by the time. Where there are no rests it is taken over
    intervals of equal length.

    Parameters
    ----------
    run : Trajectory
        Sampled several times each transverse period.
    width : float, optional
        Least time to average over, s; many transverse periods.

    Returns
    -------
    DataArray
        Over ``time`` (s), the middle of each interval; empty if slip comes before two of them.
    """
    import xarray as xr

    times, X = run.data["time"].values, run.data["X"].values
    end = first_slip_time(run)
    rests = run.stick_intervals[run.stick_intervals[:, 1] < end, 1]
    edges = list(rests[:1]) or [times[0]]
    for rest in rests:
        if rest - edges[-1] >= width:
            edges.append(rest)
    edges += list(np.arange(edges[-1] + width, end, width))
    borders = np.array(edges)
    velocity = np.diff(np.interp(borders, times, X)) / np.diff(borders)
    middle = 0.5 * (borders[1:] + borders[:-1])
    return xr.DataArray(
        velocity,
        {"time": ("time", middle, {"units": "s"})},
        name="V_X",
        attrs={"units": "m/s", "long_name": "mean velocity along the drive direction"},
    )
