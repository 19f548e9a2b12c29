"""Means: of equal parts, and of values among which a few are wild."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.arrays import Floats, Indices

CUT = 0.1  # share of the values left out at each end


class Mean(NamedTuple):
    """A mean and its standard error, in the unit of the values."""

    value: float
    error: float


def part_starts(size: int, parts: int) -> Indices:
    """Return where equal parts of so many samples begin: fewer parts, if some would be empty."""
    return np.linspace(0, size, min(parts, size), endpoint=False).astype(np.intp)


def part_means(values: Floats, parts: int) -> Floats:
    """Return the means of equal parts of some values, see `part_starts`."""
    starts = part_starts(len(values), parts)
    return np.asarray(np.add.reduceat(values, starts) / np.diff(starts, append=len(values)))


def trimmed_mean(values: Floats) -> Mean:
    """Return the mean without the smallest and the largest tenth, and its standard error.

    The error is that of the winsorised values (J. W. Tukey & D. H. McLaughlin, Sankhya A 25, 331
    (1963)), for independent values. The mean of no values, and the error of a single one, are NaN.
    Unlike a median, the mean of discretised values resolves less than a step.

    Parameters
    ----------
    values : ndarray
        (n,), in any order.
    """
    count = len(values)
    if count == 0:
        return Mean(np.nan, np.nan)
    cut = int(CUT * count)
    ordered = np.sort(values)
    kept = ordered[cut : count - cut]
    value = float(kept.mean())
    if count == 1:
        return Mean(value, np.nan)
    back = np.clip(ordered, kept[0], kept[-1])
    return Mean(value, float(back.std(ddof=1)) / (1.0 - 2.0 * cut / count) / count**0.5)
