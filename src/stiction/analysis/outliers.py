"""Wild samples: one to three in a row that jump off a signal and back."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

FAR = 8.0  # times the typical step from sample to sample
STEEPER = 3.0  # than the signal is on either side: a quick movement that is sampled is none
WIDEST = 3  # samples
PASSES = 3  # one beside another is seen once that one is gone
MOST = 0.05  # of the samples: if there are more, they are the signal


def without_outliers(values: Floats) -> Floats:
    """Return the values with wild samples on the straight line between their neighbours.

    Parameters
    ----------
    values : ndarray
        (n,), in any unit; returned as it is if none is wild.
    """
    kept, wild = values, np.zeros(len(values), bool)
    for _ in range(PASSES):
        found = np.zeros(len(values), bool)
        for width in range(1, WIDEST + 1):
            found |= _outliers(kept, width)
        if not found.any():
            break
        wild |= found
        if wild.mean() > MOST:
            return values
        at = np.flatnonzero(~wild)
        kept = values.copy()
        kept[wild] = np.interp(np.flatnonzero(wild), at, values[at])
    return kept


def _outliers(values: Floats, width: int) -> NDArray[np.bool_]:
    """Return which samples belong to runs of some width that jump off and back."""
    n, found = len(values), np.zeros(len(values), bool)
    if n < width + 6:
        return found
    steps = np.abs(np.diff(values))
    typical = float(np.median(steps[steps > 0.0])) if steps.any() else 0.0
    first = np.arange(3, n - width - 2)  # of the run; three samples before it and after it
    left, right = values[first - 1], values[first + width]
    off = np.full(len(first), np.inf)
    for k in range(width):
        line = left + (right - left) * (k + 1) / (width + 1)
        off = np.minimum(off, np.abs(values[first + k] - line))
    slopes = [
        np.minimum(np.abs(end - values[at]), 0.5 * np.abs(end - values[beyond]))
        for end, at, beyond in (
            (left, first - 2, first - 3),
            (right, first + width + 1, first + width + 2),
        )
    ]
    bound = np.maximum.reduce([*slopes, np.abs(right - left)])
    runs = first[(off > FAR * typical) & (off > STEEPER * bound)]
    for k in range(width):
        found[runs + k] = True
    return found
