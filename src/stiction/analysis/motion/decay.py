"""Swings that die out: a transient on the way to steady sliding, no cycles."""

from __future__ import annotations

from math import nan

import numpy as np
from numpy.typing import ArrayLike

ORDERED = -0.9  # rank correlation of size and number: each smaller than the last, but for noise
# Swings in such order, how many, and what is left of the first: by chance once in a thousand
# records; fewer do where no swing follows for three periods, which is evidence by itself.
MANY, LEFT = 8, 1 / 3
FEW, LEFT_BEFORE_QUIET = 3, 1 / 2
QUIET = 3.0


def dies_out(drop: ArrayLike, period: ArrayLike, rest: float) -> bool:
    """Return whether swings get smaller and smaller until (nearly) nothing is left.

    Parameters
    ----------
    drop, period : array
        (n,) of each swing, in any unit and in that of `rest`.
    rest : float
        Time from the last of them to the end of the record.
    """
    size = np.asarray(drop, dtype=np.float64)
    quiet = len(size) > 0 and rest > QUIET * float(np.max(period))
    enough, left = (FEW, LEFT_BEFORE_QUIET) if quiet else (MANY, LEFT)
    return len(size) >= enough and order(size) <= ORDERED and bool(size[-1] < left * size[0])


def order(values: np.ndarray) -> float:
    """Return the rank correlation (Spearman's) of the values with their number: -1 for falling.

    NaN for a single value, which is in no order.
    """
    if len(values) < 2:
        return nan
    ranks = np.argsort(np.argsort(values))
    return float(np.corrcoef(ranks, np.arange(len(values)))[0, 1])
