"""The times of the samples of a run from which a study takes its measures."""

from __future__ import annotations

from collections.abc import Callable
from math import ceil
from typing import NamedTuple

import numpy as np

from stiction.analysis.motion.noiseless.resolution import imposed_rate, least_rate
from stiction.analysis.motion.vibration import FAST_PERIODS
from stiction.arrays import Floats
from stiction.simulation import sample_times, step_times
from stiction.system.description import Description
from stiction.system.slider import Slider

LEAST_SAMPLES = 64  # of a run
# A prime: else a round number of periods in a run could have all samples at one phase
MOST_SAMPLES = 999_983
# The fast oscillation is measured over its last periods.
PER_FAST_PERIOD = 16
# A run of more even samples is sampled by the steps of the solver, if these are fewer: a mass that
# rests for long, or creeps, needs few. Beside them there are so many even ones, to show the course
MANY_SAMPLES, COURSE_SAMPLES = 50_000, 4096
PER_STEP = 4  # a step is about a radian of the fastest motion
CLOSEST = 1e-5  # of a fast period: samples closer than that are one
FINEST = 4 * PER_FAST_PERIOD  # steps in a fast period: shorter ones only begin or end a segment


class SampleTimes(NamedTuple):
    """The times at which a run is sampled, denser near its end.

    Parameters
    ----------
    times : ndarray
        (n,), s.
    fine : int
        Index of the first of the denser samples.
    parts : int
        Number of denser samples per other one.
    enough : bool
        Whether the samples are as dense as the known frequencies of the system need.
    even : bool
        Whether they are evenly spaced, or follow the steps of the solver.
    """

    times: Floats
    fine: int
    parts: int
    enough: bool
    even: bool


def sampling_of(description: Description, report: Callable[[float], None] | None) -> SampleTimes:
    """Return times as dense as measures need, at least as dense as a description states."""
    start, duration = description.initial.time, description.run.duration
    least = max(_least_rate(description), LEAST_SAMPLES / duration)
    needed, stated = duration * least, _stated_rate(description)
    if needed > MANY_SAMPLES and not 0.5 * least < stated <= MOST_SAMPLES / duration:
        steps = step_times(description, min(needed, MOST_SAMPLES) / PER_STEP, report)
        if steps is not None:
            return by_steps(description, steps, least)
    rate = min(least, MOST_SAMPLES / duration)
    even = sample_times(start, duration, rate)
    fast = description.slider.natural_frequencies[1]
    return with_dense_end(even, rate, fast, rate >= least, even=True)


def _least_rate(description: Description) -> float:
    """Return the rate of even samples (1/s) that a system needs, or its description states."""
    return max(least_rate(description.slider), description.run.sample_rate or 0.0)


def _stated_rate(description: Description) -> float:
    """Return the rate (1/s) that a description states, or that its drive and load need."""
    return max(description.run.sample_rate or 0.0, imposed_rate(description.slider))


def by_steps(description: Description, steps: Floats, least: float) -> SampleTimes:
    """Return times that divide the steps of the solver, and the course of the run.

    The last of them, over which the fast oscillation is measured, are at the least even rate.
    """
    start, duration = description.initial.time, description.run.duration
    fast = description.slider.natural_frequencies[1]
    most = min(max(_stated_rate(description), COURSE_SAMPLES / duration), MOST_SAMPLES / duration)
    count = min(ceil(FAST_PERIODS * least / fast), ceil(least * duration) - 1)
    end = start + duration - np.arange(count + 1)[::-1] / least
    apart = np.diff(np.floor((steps - start) * FINEST * fast)) > 0.0
    kept = steps[np.append(apart, True) | np.append(True, apart)]  # both sides of a long one
    least_gap = CLOSEST / fast
    inside = kept[(kept > start + least_gap) & (kept < end[0] - least_gap)]
    inside = inside[np.diff(inside, prepend=start) > least_gap]
    borders = np.concatenate([[start], inside, end[:1]])
    parts = np.maximum(np.ceil(np.diff(borders) * most), PER_STEP)
    times = np.concatenate([divide(borders, parts)[:-1], end])
    return with_dense_end(times, least, fast, enough=False, even=False)


def refine(sampling: SampleTimes, parts: Floats, slider: Slider) -> SampleTimes | None:
    """Return a sampling of which some intervals, before its end, are divided; None for too many."""
    fine = sampling.fine
    if len(sampling.times) + parts[:fine].sum() > MOST_SAMPLES:
        return None
    coarse = np.append(sampling.times[:fine], sampling.times[fine :: sampling.parts])
    times = np.append(divide(coarse[: fine + 1], parts[:fine])[:-1], coarse[fine:])
    rate, fast = 1.0 / float(coarse[-1] - coarse[-2]), slider.natural_frequencies[1]
    return with_dense_end(times, rate, fast, enough=False, even=False)


def divide(borders: Floats, parts: Floats) -> Floats:
    """Return times that divide each interval into its number of equal parts.

    Examples
    --------
    >>> divide(np.array([0.0, 1.0, 4.0]), np.array([2, 3]))
    array([0. , 0.5, 1. , 2. , 3. , 4. ])
    """
    counts = parts.astype(np.int64)
    first = np.repeat(np.cumsum(counts) - counts, counts)
    share = (np.arange(counts.sum()) - first) / np.repeat(counts, counts)
    times = np.repeat(borders[:-1], counts) + share * np.repeat(np.diff(borders), counts)
    return np.append(times, borders[-1])


def with_dense_end(
    times: Floats, rate: float, fast: float, enough: bool, even: bool
) -> SampleTimes:
    """Return a sampling of which the last intervals, at this rate, are divided into parts."""
    parts = max(ceil(PER_FAST_PERIOD * fast / rate), 1)
    steps = min(ceil(FAST_PERIODS * rate / fast), len(times) - 1)
    fine = len(times) - 1 - steps
    dense = times[fine] + np.arange(steps * parts + 1) / (rate * parts)
    found = np.minimum(np.concatenate([times[:fine], dense]), times[-1])
    return SampleTimes(found, fine, parts, enough, even)


def even_times(description: Description) -> Floats:
    """Return even times at the least rate that the known frequencies of a system need."""
    start, duration = description.initial.time, description.run.duration
    rate = min(_least_rate(description), MOST_SAMPLES / duration)
    return sample_times(start, duration, rate)
