"""The gain of a mass on its drive while a spring is loaded, in one pass of compiled code."""

from __future__ import annotations

import numpy as np

from stiction.solver.compilation.jit import compiled


@compiled
def find_slip(
    time: np.ndarray, elongation: np.ndarray, drive: np.ndarray, least: float
) -> tuple[int, int]:
    """Return the samples of `FirstLoading`, for a gain of at least so much on the drive (m).

    While the drive holds, its way is that of its last motion; before its first, that of this one.
    """
    n, fastest, moves = len(time), np.abs(drive).max(), drive[drive != 0.0]
    way = np.sign(moves[0]) if len(moves) > 0 else 0.0
    lag, behind, peak, slip = np.zeros(n), 0.0, 0.0, 0
    for i in range(1, n):
        v = drive[min(i, len(drive) - 1)]
        way = np.sign(v) if v != 0.0 else way
        loaded = way * (elongation[i] - elongation[i - 1])
        lag[i] = lag[i - 1] + (loaded if v != 0.0 else 0.0)
        behind += loaded + (0.0 if v != 0.0 else fastest * (time[i] - time[i - 1]))
        if behind > peak:
            peak, slip = behind, i
        elif peak - behind > least:
            return slip, slip
    enough, end = lag.max() - least, 0
    while lag[end] < enough:
        end += 1
    return -1, end
