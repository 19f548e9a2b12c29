"""Turning points of samples without noise, in one pass of compiled code."""

from __future__ import annotations

import numpy as np

from stiction.solver.compilation.jit import compiled_with_arrays


@compiled_with_arrays
def zigzag(values: np.ndarray, height: float) -> np.ndarray:
    """Return the indices of alternating maxima and minima between legs higher than `height`.

    The two ends do not count.
    """
    found = np.empty(len(values), np.int64)
    n, way, last, high, low = 0, 0, 0, 0, 0  # way: 1 rising, -1 falling, 0 unknown
    for i in range(1, len(values)):
        if way == 0:
            high = i if values[i] > values[high] else high
            low = i if values[i] < values[low] else low
            if values[high] - values[low] > height:
                way = 1 if high > low else -1
                last = max(high, low)
                if min(high, low) > 0:
                    found[n] = min(high, low)
                    n += 1
        elif way * (values[i] - values[last]) > 0.0:
            last = i
        elif way * (values[last] - values[i]) > height:
            found[n] = last
            n += 1
            way, last = -way, i
    return found[:n]
