"""The slow motion before slip, as a run shows it."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.system.slider import Slider
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    import xarray as xr

Floats = NDArray[np.float64]

# By how much a slip gains on the drive, of its speed over the slower and over the faster angular
# frequency: half a swing on the soft spring, half as fast again as the drive, gains as much as the
# first; a transverse swing between rest and twice the drive's speed gains 2 of the second, and 2.1
# has been seen at any angle.
GAINED, SWUNG = 1.0, 3.0


class Loading(NamedTuple):
    """How a spring is loaded from the start on.

    Parameters
    ----------
    slip : int
        The sample at which the first slip begins, -1 if there is none.
    end : int
        The sample at which creep ends: there, or where the spring is loaded but for what a slip
        gains at least.
    """

    slip: int
    end: int


def loading(slider: Slider, elongation: Floats, drive: Floats) -> Loading:
    """Return where the first slip begins.

    In a slip the mass gains on the drive, and the spring's elongation along it falls: by more
    than a transverse swing makes, which can be faster than the drive as well, and by more than
    an approach to steady sliding that overshoots a little. It begins where the elongation is
    largest.

    Parameters
    ----------
    slider : Slider
        What is pulled.
    elongation : ndarray
        (n,), of the spring along X, u_x cos(phi) + u_y sin(phi), m.
    drive : ndarray
        (n,), its velocity along X, m/s.
    """
    lag = np.concatenate([[0.0], np.cumsum(np.sign(drive[1:]) * np.diff(elongation))])
    slow, fast = slider.natural_frequencies
    least = np.abs(drive).max() / (2.0 * pi) * max(GAINED / slow, SWUNG / fast)
    gained = np.flatnonzero(np.maximum.accumulate(lag) - lag > least)
    if len(gained):
        slip = int(np.argmax(lag[: gained[0]]))
        return Loading(slip, slip)
    return Loading(-1, int(np.argmax(lag >= lag.max() - least)))


def _loading(run: Trajectory) -> Loading:
    data, (c, s) = run.data, run.slider.direction
    elongation = c * data["u_x"].values + s * data["u_y"].values
    return loading(run.slider, elongation, data["drive_X"].values)


def first_slip_time(run: Trajectory) -> float:
    """Return when the first slip begins (s), see `loading`; the run's last time if none does."""
    return float(run.data["time"].values[_loading(run).slip])


def creep_end(run: Trajectory) -> float:
    """Return when the creep from the start on ends (s), with a slip or without: see `Loading`."""
    return float(run.data["time"].values[_loading(run).end])


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
