"""Means of equal parts, means that ignore wild values, and signals without wild values."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.arrays import Floats, Indices, compute_once, median

CUT = 0.1  # share of the values left out at each end
FAR = 8.0  # times the typical step from sample to sample
FARTHER = 2.0  # times the motion on either side: a fast movement is not an outlier
WIDEST = 4  # samples in a row: two pairs
LONGEST_GROUP = 8  # samples in a group from first to last, including correct ones
BESIDE = 3  # samples on either side for the motion of the signal; one of them may be wild
PASSES = 4  # a group beside another is seen after that one is removed
MEANS_OF_RECORD = 400  # a longer one is not resolved by its samples but by these
MOST_WILD = 0.05  # of the samples: if there are more, they are the signal


class Mean(NamedTuple):
    """A mean and its standard error, in the unit of the values."""

    value: float
    error: float


def median_of_three(first: NDArray[Any], second: NDArray[Any], third: NDArray[Any]) -> NDArray[Any]:
    """Return the median of the three values at each place; none is NaN.

    >>> median_of_three(*np.array([[3, 1], [1, 9], [2, 5]])).tolist()
    [2, 5]
    """
    low, high = np.minimum(first, second), np.maximum(first, second)
    return np.asarray(np.maximum(low, np.minimum(high, third)))


def inner_product(first: Floats, second: Floats) -> float:
    """Return the sum of products of two long arrays, on one processor.

    For ``first @ second`` of more than 10 000 samples BLAS starts threads, which take a hundred
    times as long where other work keeps the processors busy.

    >>> inner_product(np.array([1.0, 2.0]), np.array([3.0, 4.0]))
    11.0
    """
    return float((first * second).sum())


def part_starts(size: int, parts: int) -> Indices:
    """Return where equal parts of so many samples begin: fewer parts, if some would be empty."""
    return np.linspace(0, size, min(parts, size), endpoint=False).astype(np.intp)


def part_means(values: Floats, parts: int) -> Floats:
    """Return the means of equal parts of some values, see `part_starts`."""
    starts = part_starts(len(values), parts)
    return np.asarray(np.add.reduceat(values, starts) / np.diff(starts, append=len(values)))


def block_means(values: Floats, block: int) -> Floats:
    """Return the means of blocks of samples, the last incomplete one left out."""
    whole = len(values) // block * block
    means: Floats = values[:whole].reshape(-1, block).mean(axis=1)
    return means


def uniform_mean(values: Floats, length: int) -> Floats:
    """Return the running mean over `length` values."""
    from scipy.ndimage import uniform_filter1d  # type: ignore[attr-defined]

    return np.asarray(uniform_filter1d(values, max(length, 1), mode="nearest"))


def trimmed_mean(values: Floats) -> Mean:
    """Return the mean without the smallest and the largest tenth, and its standard error.

    The error is that of the winsorised values (J. W. Tukey & D. H. McLaughlin, Sankhya A 25, 331
    (1963)), for independent values. The mean of no values, and the error of a single one, are NaN.
    Unlike a median, the mean of discretised values resolves less than a step.
    """
    if len(values) == 0:
        return Mean(np.nan, np.nan)
    value, error = trimmed_means(values, np.zeros(1, np.intp))
    return Mean(float(value[0]), float(error[0]))


def trimmed_means(values: Floats, starts: Indices) -> tuple[Floats, Floats]:
    """Return `trimmed_mean` of each part of some values, and its standard error.

    Each part begins at one of `starts`; none is empty.
    """
    count = np.diff(starts, append=len(values))
    part = np.repeat(np.arange(len(starts)), count)
    ordered = values[np.lexsort((values, part))]
    middle = ordered[starts + count // 2]
    ordered = ordered - middle[part]  # so that sums keep the digits of the differences
    cut = (CUT * count).astype(np.intp)
    first, last = starts + cut, starts + count - 1 - cut
    at = np.arange(len(values))
    kept = np.where((at >= first[part]) & (at <= last[part]), ordered, 0.0)
    back = np.clip(ordered, ordered[first][part], ordered[last][part])
    back -= (np.add.reduceat(back, starts) / count)[part]
    with np.errstate(invalid="ignore"):  # of a single value
        deviation = np.sqrt(np.add.reduceat(back**2, starts) / (count - 1))
    mean = middle + np.add.reduceat(kept, starts) / (last - first + 1)
    return mean, deviation / (1.0 - 2.0 * cut / count) / np.sqrt(count)


def without_outliers(values: Floats) -> Floats:
    """Replace wild samples by the straight line between their neighbours.

    They are returned unchanged if none is wild.
    """
    found = _replacement(values)
    return values if found is None else found


@compute_once
def _replacement(values: Floats) -> Floats | None:
    """Return values without the wild ones, which cannot be changed; None if none is wild."""
    kept, wild = values, np.zeros(len(values), bool)
    for _ in range(PASSES):
        found = _outliers(kept)
        if not found.any():
            break
        wild |= found
        if wild.mean() > MOST_WILD:
            return None
        at = np.flatnonzero(~wild)
        kept = values.copy()
        kept[wild] = np.interp(np.flatnonzero(wild), at, values[at])
        kept.setflags(write=False)
    return kept if wild.any() else None


def largest_magnitude(values: Floats) -> float:
    """Return the largest magnitude of some values, in their unit, wild samples left out."""
    return float(np.abs(without_outliers(values)).max(initial=0.0))


def _outliers(values: Floats) -> NDArray[np.bool_]:
    """Return a mask of the samples in groups that jump off and back."""
    found, steps = np.zeros(len(values), bool), np.abs(np.diff(values))
    if not steps.any():
        return found
    far = FAR * median(steps[steps > 0.0])
    jumps = np.flatnonzero(steps > far)  # the last samples before them
    for width in range(1, LONGEST_GROUP + 1):
        left = jumps[(jumps >= BESIDE) & (jumps + width + 1 + BESIDE < len(values))]
        left = left[steps[left + width] > far]
        if not left.size:
            continue
        right = left + width + 1
        rise = values[right] - values[left]
        inside = left[:, None] + np.arange(1, width + 1)
        line = values[left, None] + rise[:, None] * (inside - left[:, None]) / (width + 1)
        moves = np.maximum(_moves(values, left, -1), _moves(values, right, 1))
        bound = np.maximum(far, FARTHER * np.maximum(moves, np.abs(rise)))
        off = np.abs(values[inside] - line) > bound[:, None]
        group = off[:, 0] & off[:, -1]
        if width > WIDEST:
            rows = np.lib.stride_tricks.sliding_window_view(off, WIDEST + 1, axis=1)
            group &= ~np.any(np.all(rows, axis=2), axis=1)
        found[inside[group][off[group]]] = True
    return found


def _moves(values: Floats, at: Indices, way: int) -> Floats:
    """Return how far the signal moves on one side of samples: the median over three of them."""
    beside = values[at[:, None] + way * np.arange(1, BESIDE + 1)]
    return median_of_three(*np.abs(beside - values[at, None]).T)
