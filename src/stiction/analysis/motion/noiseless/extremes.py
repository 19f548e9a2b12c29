"""Extremes between samples whose rates are known, in compiled code."""

from __future__ import annotations

from math import sqrt

import numpy as np

from stiction.solver.compilation.jit import compiled


@compiled
def trough(step: float, change: float, before: float, after: float) -> tuple[float, float]:
    """Return when a fall ends within a step, and by how much a value has fallen then, negative.

    Slip decelerates uniformly, and may stick before the step's end, after which the rate is
    constant. The change in the step, and the rates at both ends, then determine when it was zero.
    """
    short = after * step - change
    passed = min(max(-2.0 * before * short / (after - before) ** 2, 0.0), step)
    return passed, 0.5 * before * passed


@compiled
def crest(step: float, change: float, before: float, after: float) -> tuple[float, float]:
    """Return when the cubic with these rates at both ends of a step is largest, and its rise."""
    mean = change / step
    # the rate is c s^2 + 2 b s + before, of which one root lies between
    b, c = 3.0 * mean - 2.0 * before - after, 3.0 * (before + after - 2.0 * mean)
    root = sqrt(b * b - c * before)
    s = before / (root - b) if b <= 0.0 else -(b + root) / c
    return s * step, step * s * (before + s * (b + s * c / 3.0))


@compiled
def bottom(time: np.ndarray, values: np.ndarray, rate: np.ndarray, i: int) -> tuple[float, float]:
    """Return the time and value at the end of a fall, beside a sample; see `trough`."""
    a = i if rate[i] < 0.0 else i - 1
    before, after, step = rate[a], rate[a + 1], time[a + 1] - time[a]
    if not before < 0.0 < after:
        return time[i], values[i]
    passed, fall = trough(step, values[a + 1] - values[a], before, after)
    return time[a] + passed, values[a] + fall


@compiled
def summit(
    time: np.ndarray, values: np.ndarray, rate: np.ndarray, i: int, sign: float
) -> tuple[float, float]:
    """Return time and value of a turning point beside a sample: a peak, or with -1 a trough.

    It is that of the cubic through two samples and their rates (Hermite's, see `crest`), or the
    sample itself where the rates at both do not show it; `stiction.result.peak.turning_points` for
    one interval.
    """
    a = min(max(i if sign * rate[i] > 0.0 else i - 1, 0), len(time) - 2)
    before, after, step = sign * rate[a], sign * rate[a + 1], time[a + 1] - time[a]
    if not before > 0.0 > after:
        return time[i], values[i]
    passed, rise = crest(step, sign * (values[a + 1] - values[a]), before, after)
    return time[a] + passed, values[a] + sign * rise


@compiled
def vertex(time: np.ndarray, values: np.ndarray, i: int) -> tuple[float, float]:
    """Return time and value of the vertex of the parabola through a sample and its neighbours."""
    before, after = time[i] - time[i - 1], time[i + 1] - time[i]
    rise, fall = (values[i] - values[i - 1]) / before, (values[i + 1] - values[i]) / after
    bend, slope = 2.0 * (fall - rise), rise * after + fall * before
    shift = -slope / bend if bend != 0.0 else 0.0
    return time[i] + shift, values[i] + 0.5 * slope / (before + after) * shift
