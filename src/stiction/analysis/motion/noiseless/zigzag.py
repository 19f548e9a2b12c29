"""Turning points of samples without noise, in one pass of compiled code."""

from __future__ import annotations

import numpy as np

from stiction.analysis.motion.noiseless.extremes import bottom, summit
from stiction.arrays import Floats, Indices
from stiction.solver.compilation.jit import compiled


def zigzag(values: Floats, height: float) -> Indices:
    """Return the indices of alternating maxima and minima between legs higher than `height`.

    The two ends do not count.

    Examples
    --------
    >>> zigzag(np.array([0.0, 2.0, 1.9, 3.0, 1.0, 2.0]), 0.5)
    array([3, 4])
    """
    places, none = np.arange(len(values), dtype=np.float64), np.zeros(len(values))
    if not len(values):
        return np.zeros(0, np.intp)
    when, turn = np.empty(len(values)), np.empty(len(values))
    count = find_turns(places, np.asarray(values, np.float64), none, height, when, turn)
    return when[:count].astype(np.intp)


@compiled
def find_turns(
    time: np.ndarray,
    values: np.ndarray,
    rate: np.ndarray,
    height: float,
    when: np.ndarray,
    turn: np.ndarray,
) -> int:
    """Find alternating maxima and minima between legs higher than `height`; return their number.

    They may lie between samples (n,), where rates change their sign. Their times and values are
    written into `when` and `turn`, (2 n,) each. The two ends do not count.
    """
    found, way, start = 0, 0, time[0]  # way: 1 rising, -1 falling, 0 unknown
    last_time, high_time, low_time = start, start, start
    last, high, low = values[0], values[0], values[0]
    for i in range(1, len(time)):
        between = rate[i - 1] * rate[i] < 0.0
        for k in range(2 if between else 1):
            at, value = time[i], values[i]
            if between and k == 0:
                if rate[i] > 0.0:
                    at, value = bottom(time, values, rate, i - 1)
                else:
                    at, value = summit(time, values, rate, i - 1, 1.0)
            if way == 0:
                if value > high:
                    high_time, high = at, value
                if value < low:
                    low_time, low = at, value
                if high - low > height:
                    way = 1 if high_time > low_time else -1
                    first_time, first = (low_time, low) if way > 0 else (high_time, high)
                    last_time, last = (high_time, high) if way > 0 else (low_time, low)
                    if first_time > start:
                        when[found], turn[found] = first_time, first
                        found += 1
            elif way * (value - last) > 0.0:
                last_time, last = at, value
            elif way * (last - value) > height:
                when[found], turn[found] = last_time, last
                found += 1
                way, last_time, last = -way, at, value
    return found
