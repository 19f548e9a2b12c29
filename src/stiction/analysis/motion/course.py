"""The course of a force without cycles: loading, settling, staying, or dying out."""

from __future__ import annotations

from math import nan
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from stiction.analysis.signals.digitised import resolution
from stiction.analysis.signals.robust import MEANS_OF_RECORD, part_means, part_starts
from stiction.analysis.signals.turning_points import without_spikes
from stiction.arrays import NORMAL_MEDIAN, Floats, median
from stiction.recording.noise import white_noise

ORDERED = -0.9  # rank correlation of size and number: each smaller than the last, but for noise
# Swings in such order, how many, and what is left of the first: by chance once in a thousand
# records; fewer do where no swing follows for three periods, which is evidence by itself.
MANY, LEFT = 8, 1 / 3
FEW_SWINGS, LEFT_BEFORE_QUIET = 3, 1 / 2  # counted from the largest, if it is quiet for long after
QUIET = 3.0
LEFT_OF_TWO = 2 / 3  # of only two swings, if it is quiet for long after
# Fewer swings, of any number from three, die out if each is smaller than the last by about the same
# factor: the largest and the smallest factor differ by less. Of irregular vibrations 3 in 100 have
# three such swings, 7 in 1000 four, 2 in 1000 five.
STEADILY = 0.3
BEGINS_UNLOADED = 0.3  # of the largest force, below which a record begins with an unloaded spring
PER_QUARTER = 8  # medians in each quarter of a record: few enough to be free of noise
COURSE_PARTS = 4 * PER_QUARTER
# A lone fall: its share of the record's time at most, and its height in standard deviations of the
# noise, whose range over a million samples is 10
BRIEF, STANDS_OUT = 1 / 16, 15.0
# Standard deviations of a mean by which a final fall stands out: the largest of `MEANS_OF_RECORD`
# exceeds the last by so much once in a thousand records, were there no loading
FALLS_BY = 6.0


def dies_out(drop: ArrayLike, period: ArrayLike, rest: float) -> bool:
    """Return whether swings decrease until (nearly) nothing is left.

    They may grow first, while the spring is loaded, if the quiet afterwards lasts longer than they
    did, or if as many as show it by themselves, the later half, decrease.

    The `rest` is the time from the last of them until the drive or the load changes, or the record
    ends, in the unit of their periods.
    """
    size = np.asarray(drop, dtype=np.float64)
    quiet = is_over(np.asarray(period), rest)
    if quiet and rest > float(np.sum(period)):
        size = size[int(np.argmax(size)) :]
    if quiet and len(size) == 2:
        return bool(size[-1] < LEFT_OF_TWO * size[0])
    enough, left = (FEW_SWINGS, LEFT_BEFORE_QUIET) if quiet else (MANY, LEFT)
    if len(size) < enough:
        return _decays_steadily(size)
    halves = (size, size[len(size) // 2 :]) if len(size) >= 2 * MANY else (size,)
    return any(order(each) <= ORDERED and bool(each[-1] < left * each[0]) for each in halves)


def is_over(period: Floats, rest: float) -> bool:
    """Return whether it is quiet for long after some swings, so that without noise none follows.

    The `rest` is as for `dies_out`.
    """
    return len(period) > 0 and bool(rest > QUIET * period.max())


def _decays_steadily(size: Floats) -> bool:
    """Return whether a few swings decay by about the same factor each."""
    if len(size) < FEW_SWINGS or not size[-1] < LEFT * size[0]:
        return False
    factor = size[1:] / size[:-1]
    return bool(factor.max() < 1.0 and np.ptp(factor) < STEADILY)


def order(values: np.ndarray) -> float:
    """Return Spearman's rank correlation of values with their index: -1 for falling.

    NaN for a single value.
    """
    if len(values) < 2:
        return nan
    ranks = np.argsort(np.argsort(values))
    return float(np.corrcoef(ranks, np.arange(len(values)))[0, 1])


def lone_fall(time: Floats, force: Floats) -> tuple[float, float] | None:
    """Return time (s) and height (N) of the largest fall, if it is quick and stands out of noise.

    So does a single slip, in a record that else slides steadily, or a knock. No other fall is half
    as high.
    """
    begin, end, height = _largest_fall(force)
    others = max(_largest_fall(part)[2] for part in (force[:begin], force[end:]))
    steps = np.abs(np.diff(force))
    step = float(np.median(steps[steps > 0.0])) if steps.any() else 0.0  # of a digitised force
    noise = max(float(np.median(np.abs(force - np.median(force)))) / NORMAL_MEDIAN, step)
    quick = float(time[end] - time[begin]) < BRIEF * float(time[-1] - time[0])
    alone = height > max(STANDS_OUT * noise, 2.0 * others)
    return (float(time[begin]), height) if quick and alone else None


def final_fall(time: Floats, force: Floats) -> tuple[float, float] | None:
    """Return begin (s) and height (N) of the fall with which a record of a loading ends.

    None if it does not stand out of the noise, or if the force has fallen as far before.
    """
    means = part_means(without_spikes(force), MEANS_OF_RECORD)
    size = len(force) / len(means)
    noise = max(white_noise(force, order=2) / size**0.5, resolution(force))
    below, top = np.maximum.accumulate(means) - means, int(np.argmax(means))
    height = float(below[-1])
    if height <= max(FALLS_BY * noise, float(below[: top + 1].max())):
        return None
    return float(time[part_starts(len(force), MEANS_OF_RECORD)[top]]), height


def _largest_fall(force: Floats) -> tuple[int, int, float]:
    """Return begin, end and height of the largest fall of a force."""
    if not len(force):
        return 0, 0, 0.0
    below = np.maximum.accumulate(force) - force
    end = int(np.argmax(below))
    begin = int(np.flatnonzero(below[: end + 1] <= 0.5 * below[end])[-1])
    return begin, end, float(below[end])


class Course(NamedTuple):
    """The course of a force, from its medians, or means, over 32 equal parts.

    Parameters
    ----------
    change : float
        From the first part to the last, N.
    span : float
        Highest less lowest, N.
    late_span : float
        Highest less lowest in the last quarter, N.
    one_way : float
        Magnitude of `change` over the sum of all ups and downs: 1 for a monotone course.
    early_rate, late_rate : float
        Mean rates over the first and the last quarter, N/s.
    scatter : float
        Standard deviation of the samples about the medians, N; NaN where the samples are not known.
    """

    change: float
    span: float
    late_span: float
    one_way: float
    early_rate: float
    late_rate: float
    scatter: float = nan


def course(time: Floats, force: Floats) -> Course:
    """Return the course of a force of at least `COURSE_PARTS` samples."""
    edges = np.linspace(0, len(time), COURSE_PARTS + 1).astype(np.intp)[1:-1]
    parts = np.split(force, edges)
    f = np.array([median(part) for part in parts])
    t = np.array([part.mean() for part in np.split(time, edges)])
    scatter = np.sqrt(np.mean(np.concatenate([p - m for p, m in zip(parts, f, strict=True)]) ** 2))
    return course_of_parts(t, f)._replace(scatter=float(scatter))


def course_of_parts(t: Floats, f: Floats) -> Course:
    """Return the course of a force from its values in the `COURSE_PARTS` parts, at some times."""
    ups_and_downs = float(np.abs(np.diff(f)).sum())
    return Course(
        change=float(f[-1] - f[0]),
        span=float(np.ptp(f)),
        late_span=float(np.ptp(f[-PER_QUARTER:])),
        one_way=abs(float(f[-1] - f[0])) / ups_and_downs if ups_and_downs else 0.0,
        early_rate=float((f[PER_QUARTER] - f[0]) / (t[PER_QUARTER] - t[0])),
        late_rate=float((f[-1] - f[-1 - PER_QUARTER]) / (t[-1] - t[-1 - PER_QUARTER])),
    )
