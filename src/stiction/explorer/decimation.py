"""Curves for a screen: in each column of pixels the first, lowest, highest and last value.

A line through these four covers the same pixels as a line through all samples, so that no peak is
lost (Jugel et al., Proc. VLDB Endow. 7 (2014), 797, "M4").
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stiction.arrays import Floats

Indices = NDArray[np.int64]


def columns_of(times: Floats, window: tuple[float, float], count: int) -> tuple[Indices, Indices]:
    """Return the columns that hold samples, and the first sample of each and of the rest.

    Parameters
    ----------
    times : ndarray
        (n,), ascending, s.
    window : tuple of float
        Start and end of the picture, s.
    count : int
        Number of columns.

    Returns
    -------
    tuple of ndarray
        Numbers of the k columns, and k + 1 indices.
    """
    low, high = window
    first = int(np.searchsorted(times, low, side="left"))
    last = int(np.searchsorted(times, high, side="right"))
    place = np.floor((times[first:last] - low) * (count / (high - low)))
    column = np.clip(place, 0, count - 1).astype(np.int64)
    starts = np.flatnonzero(np.diff(column, prepend=-1))
    return column[starts], np.append(starts, len(column)) + first


def extremes(values: Floats, starts: Indices) -> Floats:
    """Return the first, lowest, highest and last value of each column, (k, 4); NaN is left out.

    Examples
    --------
    >>> times = np.linspace(0.0, 1.0, 9)
    >>> columns, starts = columns_of(times, (0.0, 1.0), 2)
    >>> extremes(np.sin(9.0 * times), starts).shape
    (2, 4)
    """
    if len(starts) < 2:
        return np.empty((0, 4))
    part, first = values[: starts[-1]], starts[:-1]
    rows = (
        values[first],
        np.fmin.reduceat(part, first),
        np.fmax.reduceat(part, first),
        values[starts[1:] - 1],
    )
    return np.stack(rows, axis=1)


def share_stuck(sticks: Floats, window: tuple[float, float], count: int) -> NDArray[np.float32]:
    """Return the share of each column's time that lies in stick intervals (n, 2), whatever length.

    Examples
    --------
    >>> share_stuck(np.array([[0.0, 0.25]]), (0.0, 1.0), 2)
    array([0.5, 0. ], dtype=float32)
    """
    edges = np.linspace(*window, count + 1)
    lengths = np.append(0.0, np.cumsum(sticks[:, 1] - sticks[:, 0]))
    which = np.searchsorted(sticks[:, 0], edges, side="right")
    before = np.maximum(which - 1, 0)
    done = lengths[which]
    if len(sticks):
        beyond = np.maximum(sticks[before, 1] - edges, 0.0)  # of the interval that still lasts
        done = done - np.where(which > 0, beyond, 0.0)
    return (np.diff(done) / np.diff(edges)).astype(np.float32)
