"""Features of a run's samples, found in one pass of compiled code without Python's lock.

The samples must come from the solver, without noise; all else of `stiction.analysis` handles any
record.
"""

from __future__ import annotations

from math import pi
from typing import NamedTuple

import numpy as np

from stiction.analysis.motion.course import COURSE_PARTS
from stiction.analysis.motion.noiseless.extremes import vertex
from stiction.analysis.motion.noiseless.resolution import REVERSAL
from stiction.analysis.motion.noiseless.zigzag import find_turns
from stiction.analysis.record import ExactForce
from stiction.arrays import Floats
from stiction.drive import ConstantVelocity
from stiction.drive.program import nominal_velocity
from stiction.solver.compilation.jit import compiled
from stiction.system.slider import Slider


class Features(NamedTuple):
    """Features of a run's samples.

    Parameters
    ----------
    peak : float
        Largest force, N.
    late_mean, late_span : float
        Mean force in the last quarter, and its span from lowest to highest there, N; like the peak,
        the ends of the span lie between samples.
    fastest : float
        Largest velocity of the mass along the drive, m/s; it lies between samples, too.
    means : ndarray
        (parts,), force averaged over equal parts of the time, N.
    turn_time, turn_value : ndarray
        (n,), turning points of the force (s, N), alternately peaks and troughs.
    height : float
        Smallest reversal between these, N.
    first, last : float
        Force at the beginning and at the end, N.
    """

    peak: float
    late_mean: float
    late_span: float
    fastest: float
    means: Floats
    turn_time: Floats
    turn_value: Floats
    height: float
    first: float
    last: float

    @property
    def trough(self) -> bool:
        """Whether the first turning point is a trough."""
        return len(self.turn_value) > 0 and bool(self.turn_value[0] < self.first)


def features(
    time: Floats,
    force: Floats,
    rate: Floats,
    velocity: Floats,
    *,
    least: float,
    driven: int,
    parts: int,
    even: bool,
    reversal: float = REVERSAL,
) -> Features:
    """Return the features of samples.

    Parameters
    ----------
    time, force, rate, velocity : ndarray
        (n,), s, N, N/s, m/s; positive along the drive.
    least : float
        Smallest reversal of the force that counts, as a share of the largest force: smaller ones
        are errors of the solver.
    driven : int
        Number of samples until the drive stops for good.
    parts : int
        Number of means.
    even : bool
        Whether the samples are evenly spaced; else each counts for the time about it.
    reversal : float, optional
        The smallest reversal as a share of the span of the force in the last quarter of the driven
        samples.
    """
    means, when, turn = np.empty(parts), np.empty(2 * len(time)), np.empty(2 * len(time))
    peak, mean, span, fastest, height, count = fill_features(
        time, force, rate, velocity, reversal, least, driven, even, means, when, turn
    )
    turns = when[:count].copy(), turn[:count].copy()
    ends = float(force[0]), float(force[-1])
    return Features(peak, mean, span, fastest, means, *turns, height, *ends)


def features_of(known: ExactForce) -> Features:
    """Return the features of a run's force."""
    time, drive, driven = known.time, known.slider.motion, len(known.time)
    if not isinstance(drive, ConstantVelocity):
        moves = np.flatnonzero(np.hypot(*drive.rate(time)))
        driven = int(moves[-1]) + 1 if len(moves) else driven
    largest = float(np.abs(known.force).max(initial=0.0))
    swing = transverse_swing(known.slider) / largest if largest else 0.0
    return features(
        time, known.force, known.rate, known.rate, least=max(known.rtol, swing), driven=driven,
        parts=COURSE_PARTS, even=False,
    )  # fmt: skip


def transverse_swing(slider: Slider) -> float:
    """Return the swing, N, of the transverse oscillation on a load cell at an angle of its own.

    Smaller swings are not counted as cycles, however well samples show them. The rate of that
    oscillation is at most the drive's speed, unless the slip reverses (Nakano & Popov, below
    Eq. (9)).
    """
    if slider.cell_angle is None:
        return 0.0
    cell, stiffer = slider.load_cell, slider.stiffer_axis
    share, k = abs((cell.x, cell.y)[stiffer]), (slider.k_x, slider.k_y)[stiffer]
    rate = 2.0 * pi * slider.natural_frequencies[1]
    return 2.0 * share * k * abs(nominal_velocity(slider.motion)) / rate


@compiled
def fill_features(
    time: np.ndarray,
    force: np.ndarray,
    rate: np.ndarray,
    velocity: np.ndarray,
    reversal: float,
    least: float,
    driven: int,
    even: bool,
    means: np.ndarray,
    when: np.ndarray,
    turn: np.ndarray,
) -> tuple[float, float, float, float, float, int]:
    """Return the numbers of `Features`, and that of its turning points; fill its arrays."""
    n, parts = len(time), len(means)
    low, high, fastest = force[0], force[0], velocity[0]
    for i in range(n):
        low, high = min(low, force[i]), max(high, force[i])
        fastest = max(fastest, velocity[i])
        if 0 < i < n - 1 and velocity[i - 1] < velocity[i] >= velocity[i + 1]:
            fastest = max(fastest, vertex(time, velocity, i)[1])
    late = place(time, 3, 4, n, even)
    late_low, late_high = ends(force, late, n)
    late_mean = mean(time, force, late, n, even)
    for part in range(parts):
        begin = place(time, part, parts, n, even)
        end = max(place(time, part + 1, parts, n, even), begin + 1)
        means[part] = mean(time, force, begin, end, even)
    end_low, end_high = ends(force, place(time, 3, 4, driven, even), driven)
    height = max(reversal * (end_high - end_low), least * max(high, -low))
    count = find_turns(time, force, rate, height, when, turn)
    for k in range(count):
        high = max(high, turn[k])
        if when[k] >= time[late]:
            late_low, late_high = min(late_low, turn[k]), max(late_high, turn[k])
    return high, late_mean, late_high - late_low, fastest, height, count


@compiled
def ends(values: np.ndarray, begin: int, end: int) -> tuple[float, float]:
    """Return the least and the largest of some values, up to the last before another, or that."""
    low, high = values[end - 1], values[end - 1]
    for i in range(begin, end):
        low, high = min(low, values[i]), max(high, values[i])
    return low, high


@compiled
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


@compiled
def mean(time: np.ndarray, values: np.ndarray, begin: int, end: int, even: bool) -> float:
    """Return the mean of samples over time, from one to before another."""
    total, weight = 0.0, 0.0
    for i in range(begin, end):
        at = min(i, len(values) - 1)
        share = 1.0 if even else time[min(at + 1, len(time) - 1)] - time[max(at - 1, 0)]
        total += share * values[at]
        weight += share
    return total / weight if weight > 0.0 else values[min(begin, len(values) - 1)]
