"""Where a clean signal turns: peaks and troughs higher than a given reversal."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.solver.compiled import compiled

Floats = NDArray[np.float64]


class Turns(NamedTuple):
    """Turning points in order, peaks and troughs in turn.

    Parameters
    ----------
    time, value : ndarray
        (n,), where the parabola through a sample and its neighbours turns.
    trough : bool
        Whether the first is a trough.
    """

    time: Floats
    value: Floats
    trough: bool


def turns(time: Floats, values: Floats, height: float) -> Turns:
    """Return where a signal turns by more than `height`; its ends are no turns.

    For what a solver returns, which has no noise: `stiction.analysis.turning_points` does it
    for records, and finds the height by itself.
    """
    index = zigzag(values, height)
    before, at, after = (values[index + i] for i in (-1, 0, 1))
    bend = before - 2.0 * at + after
    slope = 0.5 * (after - before)
    with np.errstate(divide="ignore", invalid="ignore"):
        shift = np.where(bend != 0.0, -slope / bend, 0.0)
    step = time[index + 1] - time[index]
    first_is_trough = len(index) > 0 and bool(values[index[0]] < values[0])
    return Turns(time[index] + shift * step, at + 0.5 * slope * shift, first_is_trough)


@compiled
def zigzag(values: np.ndarray, height: float) -> np.ndarray:
    """Return the samples, in turn highest and lowest, between legs of at least `height`."""
    found = np.empty(len(values), np.int64)
    n, way, last = 0, 0, 0  # way: 1 rising, -1 falling, 0 not known yet
    high, low = 0, 0
    for i in range(1, len(values)):
        if way == 0:
            high = i if values[i] > values[high] else high
            low = i if values[i] < values[low] else low
            if values[high] - values[low] >= height:
                way = 1 if high > low else -1
                last = high if way == 1 else low
                if min(high, low) > 0:
                    found[n] = min(high, low)
                    n += 1
        elif way * (values[i] - values[last]) > 0.0:
            last = i
        elif way * (values[last] - values[i]) >= height:
            found[n] = last
            n += 1
            way, last = -way, i
    return found[:n]
