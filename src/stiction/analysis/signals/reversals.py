"""The reversals of a signal, and its turning points without the small ones.

A leg lies between two neighbouring turning points. A leg no longer than both its neighbours is a
reversal within a larger movement, which stays whole when the leg and its two points are removed.
Topology calls its height the persistence of the pair, fatigue engineering the range of a rainflow
cycle. It needs no window and no reference level, so slow drift has no effect.

References
----------
Edelsbrunner, Letscher & Zomorodian, Discrete Comput. Geom. 28, 511 (2002); ASTM E1049-85.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stiction.arrays import Floats, Indices

Counts = NDArray[np.int64]

# A pass over arrays takes as long as a hundred points one by one: it pays where it takes out more
# than these, and one in as many points.
FEW_POINTS = 32


def extrema(values: Counts | Floats) -> Indices:
    """Return the indices of extrema and both ends; of equal neighbours, the first."""
    if len(values) < 2:
        return np.arange(len(values))
    distinct = np.append(0, np.flatnonzero(values[1:] != values[:-1]) + 1)
    its = values[distinct]
    rising = its[1:] > its[:-1]
    turns = np.flatnonzero(rising[1:] != rising[:-1]) + 1
    inner = distinct[turns]
    last = len(values) - 1
    return np.concatenate([[0], inner, [last]])


def smallest_legs(legs: Counts | Floats, below: Floats | float) -> Indices:
    """Return the inner legs that are no longer than both neighbours and shorter than a limit.

    There are never two neighbours among them: one of these is not the smaller. The limit `below` is
    one for all legs, or (n - 2,).
    """
    inner = legs[1:-1]
    small = (inner < legs[2:]) & (inner <= legs[:-2]) & (inner < below)
    return np.flatnonzero(small) + 1


def remove_reversals(
    values: Counts | Floats, below: float = np.inf
) -> tuple[Indices, NDArray[Any]]:
    """Remove reversals, the smallest of each neighbourhood first.

    All local minima of height are removed at once. Where they get few, as in a vibration whose
    amplitude changes slowly, the rest is removed in one go from left to right: in any order the
    same reversals go, because none of two that can go is in the way of the other.

    Return the indices of the remaining samples, both ends of the signal among them, and the heights
    of the removed reversals in any order; only those smaller than `below` are removed.
    """
    points, heights = extrema(values), [np.zeros(0, np.int64)]
    while len(points) > 3:
        legs = np.abs(np.diff(values[points]))
        found = smallest_legs(legs, below)
        if len(found) == 0:
            break
        if len(found) < FEW_POINTS + len(points) // FEW_POINTS:
            kept, last = _from_left_to_right(legs.tolist(), below)
            return points[kept], np.concatenate([*heights, np.array(last, np.int64)])
        heights.append(legs[found])
        points = np.delete(points, np.concatenate([found, found + 1]))
    return points, np.concatenate(heights)


def _from_left_to_right(legs: Sequence[int], below: float) -> tuple[list[int], list[int]]:
    """Return which points between legs remain without reversals, and the heights of these."""
    points: list[int] = [0]
    left: list[int] = []
    heights = []
    for point, last in enumerate(legs, 1):
        while len(left) > 1 and left[-2] >= (inner := left[-1]) < last and inner < below:
            heights.append(inner)
            left.pop()
            last += left.pop() - inner
            del points[-2:]
        points.append(point)
        left.append(last)
    return points, heights


def all_heights(values: Counts) -> Counts:
    """Return the height of every reversal; the legs left at the end grow, then shrink.

    Every second one of these counts, because a cycle has a leg up and a leg down.
    """
    points, heights = remove_reversals(values)
    left = np.sort(np.abs(np.diff(values[points]))[1:-1])
    return np.concatenate([heights, left[::2]])


def standing_out(values: Counts, height: float, least: float) -> Indices:
    """Return the turning points between legs of at least `height`.

    The first and last leg of a record may be cut: for these `least` suffices. Their outer ends are
    unknown, and left out.
    """
    points, _ = remove_reversals(values, height)
    legs = np.abs(np.diff(values[points]))
    large = np.flatnonzero(legs >= height)
    if len(large) == 0:
        return points[:0]
    first, last = large[0], large[-1]
    # of legs that are too small, the one beside the first large leg is the largest
    first += 0 if first > 0 and legs[first - 1] >= least else 1
    last += 1 if last < len(legs) - 1 and legs[last + 1] >= least else 0
    return points[first : last + 1]
