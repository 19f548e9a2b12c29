"""The gain of a mass on its drive while a spring is loaded, in one pass of compiled code."""

from __future__ import annotations

from math import copysign

import numpy as np

from stiction.solver.compilation.jit import compiled


@compiled
def find_slip(
    time: np.ndarray, elongation: np.ndarray, drive: np.ndarray, least: float, lag: np.ndarray
) -> tuple[int, int]:
    """Return the samples of `FirstLoading`, for a gain of at least so much on the drive (m).

    While the drive holds, its way is that of its last motion; before its first, that of this one.
    `lag` (n,) is filled with the way by which the spring was loaded. No NumPy function is called:
    a process would have to load the compiled copy of each.
    """
    fastest, way = 0.0, 0.0
    for v in drive:
        fastest = max(fastest, abs(v))
        way = copysign(1.0, v) if way == 0.0 and v != 0.0 else way
    behind, peak, slip, most = 0.0, 0.0, 0, 0.0
    lag[0] = 0.0
    for i in range(1, len(time)):
        v = drive[min(i, len(drive) - 1)]
        way = copysign(1.0, v) if v != 0.0 else way
        loaded = way * (elongation[i] - elongation[i - 1])
        lag[i] = lag[i - 1] + (loaded if v != 0.0 else 0.0)
        most = max(most, lag[i])
        behind += loaded + (0.0 if v != 0.0 else fastest * (time[i] - time[i - 1]))
        if behind > peak:
            peak, slip = behind, i
        elif peak - behind > least:
            return slip, slip
    end = 0
    while lag[end] < most - least:
        end += 1
    return -1, end
