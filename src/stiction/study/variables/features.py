"""Features of a run's samples, found in one pass of compiled code without Python's lock.

The samples must come from the solver, without noise; `stiction.analysis` handles any record.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.analysis.creep.slip_finder import crest, trough
from stiction.solver.compilation.jit import compiled_with_arrays
from stiction.study.variables.zigzag import zigzag


class Features(NamedTuple):
    """Features of a run's samples.

    Parameters
    ----------
    peak : float
        Largest force, N.
    late_mean, late_span : float
        Mean force in the last quarter, and its span from lowest to highest there, N; like the peak,
        the ends of the span lie between samples.
    peak_velocity : float
        Largest velocity of the mass along the drive, m/s; it lies between samples, too.
    means : ndarray
        (parts,), force averaged over equal parts of the time, N.
    turn_time, turn_value : ndarray
        (n,), turning points of the force (s, N), alternately peaks and troughs.
    trough : bool
        Whether the first turning point is a trough.
    first, last : float
        Force at the beginning and at the end, N.
    """

    peak: float
    late_mean: float
    late_span: float
    peak_velocity: float
    means: np.ndarray
    turn_time: np.ndarray
    turn_value: np.ndarray
    trough: bool
    first: float
    last: float


@compiled_with_arrays
def even_columns(
    samples: np.ndarray,
    fine: int,
    parts: int,
    drive: np.ndarray,
    way: float,
    k_x: float,
    c: float,
    s: float,
) -> np.ndarray:
    """Return force and its rate, velocity, slip speed and elongation along X, (5, n).

    Of the solver's samples, of which those from `fine` on are closer by a factor of `parts`; X is
    along (c, s), and (m,) `drive` is its velocity, one value if constant.
    """
    n = fine + (len(samples) - fine + parts - 1) // parts
    columns = np.empty((5, n))
    for i in range(n):
        row = samples[i if i < fine else fine + (i - fine) * parts]
        u_x, u_y, slip_x, slip_y = row[0], row[1], row[2], row[3]
        columns[0, i] = way * k_x * u_x
        columns[1, i] = way * k_x * (c * drive[min(i, len(drive) - 1)] - slip_x)
        columns[2, i] = way * (c * slip_x + s * slip_y)
        columns[3, i] = np.sqrt(slip_x * slip_x + slip_y * slip_y)
        columns[4, i] = c * u_x + s * u_y
    return columns


@compiled_with_arrays
def features(
    time: np.ndarray,
    force: np.ndarray,
    rate: np.ndarray,
    velocity: np.ndarray,
    reversal: float,
    least: float,
    driven: int,
    parts: int,
    even: bool,
) -> Features:
    """Return the features of samples.

    Parameters
    ----------
    time, force, rate, velocity : ndarray
        (n,), s, N, N/s, m/s; positive along the drive.
    reversal : float
        Smallest reversal of the force that counts, as a share of its span in the last quarter of
        the driven samples.
    least : float
        The same as a share of the largest force: smaller ones are errors of the solver.
    driven : int
        Number of samples until the drive stops for good.
    parts : int
        Number of means.
    even : bool
        Whether the samples are evenly spaced; else each counts for the time about it.
    """
    n = len(time)
    low, high, fastest = force[0], force[0], velocity[0]
    for i in range(n):
        low, high = min(low, force[i]), max(high, force[i])
        fastest = max(fastest, velocity[i])
        if 0 < i < n - 1 and velocity[i - 1] < velocity[i] >= velocity[i + 1]:
            fastest = max(fastest, vertex(time, velocity, i)[1])
    late, late_low, late_high = place(time, 3, 4, n, even), np.inf, -np.inf
    for i in range(late, n):
        late_low, late_high = min(late_low, force[i]), max(late_high, force[i])
    late_mean = mean(time, force, late, n, even)
    means = np.zeros(parts)
    for part in range(parts):
        begin = place(time, part, parts, n, even)
        end = max(place(time, part + 1, parts, n, even), begin + 1)
        means[part] = mean(time, force, begin, end, even)
    end_low, end_high = force[driven - 1], force[driven - 1]
    for i in range(place(time, 3, 4, driven, even), driven):
        end_low, end_high = min(end_low, force[i]), max(end_high, force[i])
    height = max(reversal * (end_high - end_low), least * max(high, -low))
    index = zigzag(force, height)
    turn_time, turn_value = np.empty(len(index) + 1), np.empty(len(index) + 1)
    trough = len(index) > 0 and force[index[0]] < force[0]
    for k, i in enumerate(index):
        if trough == (k % 2 == 0):
            turn_time[k], turn_value[k] = bottom(time, force, rate, i)
        else:
            turn_time[k], turn_value[k] = summit(time, force, rate, i, 1.0)
        high = max(high, turn_value[k])
        if turn_time[k] >= time[late]:
            late_low, late_high = min(late_low, turn_value[k]), max(late_high, turn_value[k])
    count = len(index)
    if count > 0 and trough == (count % 2 == 0):  # the last one is a peak
        # the lowest place after it may lie behind the last sample but one
        i = index[count - 1] + int(np.argmin(force[index[count - 1] : n - 1]))
        at, value = bottom(time, force, rate, i)
        if force[n - 1] - value > height:
            turn_time[count], turn_value[count] = at, value
            count += 1
    late_span = late_high - late_low
    return Features(
        high, late_mean, late_span, fastest, means, turn_time[:count], turn_value[:count], trough,
        force[0], force[n - 1],
    )  # fmt: skip


@compiled_with_arrays
def place(time: np.ndarray, part: int, parts: int, n: int, even: bool) -> int:
    """Return the index at which a part of the time of the first n samples begins."""
    if even or part == parts:
        return part * n // parts
    begins = time[0] + (time[n - 1] - time[0]) * part / parts
    low, high = 0, n - 1
    while low < high:
        middle = (low + high) // 2
        if time[middle] < begins:
            low = middle + 1
        else:
            high = middle
    return low


@compiled_with_arrays
def mean(time: np.ndarray, values: np.ndarray, begin: int, end: int, even: bool) -> float:
    """Return the mean of samples over time, from one to before another."""
    total, weight = 0.0, 0.0
    for i in range(begin, end):
        at = min(i, len(values) - 1)
        share = 1.0 if even else time[min(at + 1, len(time) - 1)] - time[max(at - 1, 0)]
        total += share * values[at]
        weight += share
    return total / weight


@compiled_with_arrays
def bottom(time: np.ndarray, values: np.ndarray, rate: np.ndarray, i: int) -> tuple[float, float]:
    """Return the time and value at the end of a fall, beside a sample; see `trough`."""
    a = i if rate[i] < 0.0 else i - 1
    before, after, step = rate[a], rate[a + 1], time[a + 1] - time[a]
    if not before < 0.0 < after:
        return time[i], values[i]
    passed, fall = trough(step, values[a + 1] - values[a], before, after)
    return time[a] + passed, values[a] + fall


@compiled_with_arrays
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


@compiled_with_arrays
def vertex(time: np.ndarray, values: np.ndarray, i: int) -> tuple[float, float]:
    """Return time and value of the vertex of the parabola through a sample and its neighbours."""
    before, after = time[i] - time[i - 1], time[i + 1] - time[i]
    rise, fall = (values[i] - values[i - 1]) / before, (values[i + 1] - values[i]) / after
    bend, slope = 2.0 * (fall - rise), rise * after + fall * before
    shift = -slope / bend if bend != 0.0 else 0.0
    return time[i] + shift, values[i] + 0.5 * slope / (before + after) * shift
