"""The gain of a mass on its drive while a spring is loaded, in one pass of compiled code.

No NumPy function is called: a process would have to load the compiled copy of each.
"""

from __future__ import annotations

from math import copysign

import numpy as np

from stiction.analysis.motion.noiseless.extremes import crest, trough
from stiction.solver.compilation.jit import compiled


@compiled
def find_slip(
    time: np.ndarray,
    elongation: np.ndarray,
    rate: np.ndarray,
    drive: np.ndarray,
    fastest: float,
    least: float,
    lag: np.ndarray,
) -> tuple[int, int]:
    """Return the samples of `FirstLoading`, for a gain of at least so much on the drive (m).

    The drive is nowhere faster than `fastest`, m/s.

    While the drive holds, its way is that of its last motion; before its first, that of this one.
    A gain begins and ends between samples, where rates of elongation (m/s) turn, as long as the
    drive moves by less than that gain from one sample to the next. `lag` (n,) is filled with the
    way by which the spring was loaded.
    """
    way = 0.0
    for v in drive:
        way = copysign(1.0, v) if way == 0.0 and v != 0.0 else way
    behind, peak, slip, most = 0.0, 0.0, 0, 0.0
    lag[0] = 0.0
    for i in range(1, len(time)):
        v, last = drive[min(i, len(drive) - 1)], drive[min(i - 1, len(drive) - 1)]
        turns = way * v < 0.0
        way = copysign(1.0, v) if v != 0.0 else way
        step, loaded = time[i] - time[i - 1], way * (elongation[i] - elongation[i - 1])
        lag[i] = lag[i - 1] + (loaded if v != 0.0 else 0.0)
        most = max(most, lag[i])
        given = 0.0 if v != 0.0 else fastest
        change = loaded + given * step
        if not turns and (v == 0.0) == (last == 0.0) and fastest * step < least:
            before, after = way * rate[i - 1] + given, way * rate[i] + given
            if (
                before < 0.0 < after
                and peak - behind - trough(step, change, before, after)[1] > least
            ):
                return slip, slip
            if before > 0.0 > after:
                top = behind + crest(step, change, before, after)[1]
                if top > peak:
                    peak, slip = top, i if change > 0.0 else i - 1
        behind += change
        if behind > peak:
            peak, slip = behind, i
        elif peak - behind > least:
            return slip, slip
    end = 0
    while lag[end] < most - least:
        end += 1
    return -1, end
