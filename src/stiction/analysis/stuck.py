"""How much time is spent at zero slip."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


def stuck_until(time: ArrayLike, sticks: ArrayLike) -> Floats:
    """Return the time (s) spent stuck up to each `time`, for stick intervals of shape (n, 2)."""
    ends = np.asarray(sticks, dtype=np.float64).reshape(-1, 2)
    if len(ends) == 0:
        return np.zeros_like(np.asarray(time, dtype=np.float64))
    total = np.cumsum(ends[:, 1] - ends[:, 0])
    known = np.column_stack([total - (ends[:, 1] - ends[:, 0]), total]).ravel()
    stuck: Floats = np.interp(np.asarray(time, dtype=np.float64), ends.ravel(), known)
    return stuck


def sticks_until(time: ArrayLike, sticks: ArrayLike) -> NDArray[np.intp]:
    """Return how many stick intervals, of shape (n, 2), have begun before each `time`."""
    begins = np.asarray(sticks, dtype=np.float64).reshape(-1, 2)[:, 0]
    return np.searchsorted(begins, np.asarray(time, dtype=np.float64))
