"""The corners of the cycles of a force, also where some of its cycles are far smaller than others.

One gap between small and large reversals cannot separate two sizes of cycles from noise: if a load
is doubled within a record, the smaller cycles may count as ripple of the larger ones. Where the
found cycles leave a long stretch free, the force is searched by itself.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.analysis.motion.changes.cycles import CHANGED, FEW_CYCLES
from stiction.analysis.motion.changes.ringing import ringing_of
from stiction.analysis.motion.course import dies_out
from stiction.analysis.motion.hesitations import cycle_corners
from stiction.analysis.signals.peak_refinement import Vertices, vertices
from stiction.analysis.signals.reversals import all_heights
from stiction.analysis.signals.robust import part_means, uniform_mean
from stiction.analysis.signals.turning_points import (
    COUNTS,
    FEWEST_PER_CYCLE,
    TurningPoints,
    as_counts,
    turning_points,
)
from stiction.arrays import Floats

FREE = 2.0  # median times between two peaks: a longer stretch without a peak is searched by itself
RISING = 0.53  # of a cycle: a mass that sticks rises for longer than it falls; a sine, for half
# Reversals beside the larger cycles that are as high as the smaller ones: of their drop, at least;
# of their number, so many make these a ripple; means of each period in which they are sought, and
# periods that tell
AS_HIGH, AS_MANY, MEANS, ENOUGH = 0.5, 0.5, 12, 400


class CycleCorners(NamedTuple):
    """The corners of cycles."""

    corners: Vertices  # troughs and peaks in turn, a trough first and last (s, N)
    dips: Vertices  # hesitations: time of the first point (s), and depth (N)
    turns: int  # number of peaks and troughs, including those of cut cycles

    @property
    def peak_time(self) -> Floats:
        """Time of each peak, s."""
        return self.corners.time[1::2]

    @property
    def period(self) -> Floats:
        """Time from trough to trough, s."""
        return np.diff(self.corners.time[::2])

    @property
    def rise_share(self) -> Floats:
        """Share of each period in which the force rises."""
        return (self.peak_time - self.corners.time[:-1:2]) / self.period

    @property
    def drop(self) -> Floats:
        """Height of each fall, N."""
        return self.corners.value[1::2] - self.corners.value[2::2]

    def with_smaller(self, begin: float, end: float, other: CycleCorners) -> CycleCorners:
        """Return these with others between two of their peaks (s), or beyond the outer ones."""
        found = []
        for own, its in zip(self[:2], other[:2], strict=True):
            before, after = own.time <= begin, own.time >= end
            columns = zip(own, its, strict=True)
            found.append(
                Vertices(*(np.concatenate([old[before], new, old[after]]) for old, new in columns))
            )
        return CycleCorners(found[0], found[1], self.turns + other.turns)


class Larger(NamedTuple):
    """The cycles of a whole force, beside which smaller ones are sought."""

    # (n,), s, N
    time: Floats
    force: Floats
    cycles: CycleCorners  # those that stand apart in the whole
    parts: list[tuple[float, float]]  # begin and end of each part with such cycles, s


def find_corners(time: Floats, force: Floats, points: TurningPoints) -> CycleCorners:
    """Return the corners of the cycles of a force.

    Where it is free of them for long, the smaller cycles are taken in that are found there by
    themselves, unless they build up or die out, or are a ripple that goes on beside the larger
    ones. Beside a ringing, as after a knock, there are none: its swings are not cycles. Nor are any
    sought beside irregular stick-slip, where cycles of every size lie between the larger ones.
    """
    whole = found = _corners(time, points)
    falls = whole.drop > 0.0  # on a steep slow motion a force may not fall at all
    peak, drop = whole.peak_time[falls], whole.drop[falls]
    if not _are_alike(drop) or ringing_of(time, peak, drop) is not None:
        return whole
    edges, done = np.concatenate([[-np.inf], whole.peak_time, [np.inf]]), 0
    stretches = _free_stretches(time, whole.peak_time)
    its = Larger(time, force, whole, _beside(edges, stretches))
    for first, last in stretches:
        smaller = _smaller_cycles(its, *edges[[first, last]])
        if smaller is None or first < done:
            continue
        wider = _extent(whole, smaller, first, last, done)
        if wider != (first, last):
            again = _smaller_cycles(its, *edges[[*wider]])
            if again is not None:
                smaller, (first, last) = again, wider
        found, done = found.with_smaller(edges[first], edges[last], smaller), last
    return found


def _corners(time: Floats, points: TurningPoints) -> CycleCorners:
    """Return the corners of cycles between turning points, without hesitations."""
    if len(points.index) < 3:
        none = Vertices(np.zeros(0), np.zeros(0))
        return CycleCorners(none, none, len(points.index))
    found = vertices(time, points)
    ends = points.before, points.after
    kept, at, depth = cycle_corners(found.value, found.time, ends, bool(points.trough[0]))
    corners = Vertices(found.time[kept], found.value[kept])
    return CycleCorners(corners, Vertices(found.time[at], depth), len(points.index))


def _free_stretches(time: Floats, peak: Floats) -> list[tuple[int, int]]:
    """Return which peaks are around each long stretch without a peak, or around two in succession.

    Peaks (s) are numbered from 1; 0 is the begin, and the next number the end. A peak between two
    stretches is the highest of smaller ones.
    """
    if len(peak) < 2:
        return []
    lasts = np.diff(np.concatenate([time[:1], peak, time[-1:]]))
    free = np.concatenate([[0], lasts > FREE * np.median(np.diff(peak)), [0]])
    ends = np.flatnonzero(np.diff(free)).tolist()
    return [*zip(ends[::2], ends[1::2], strict=True)]


def _beside(edges: Floats, stretches: list[tuple[int, int]]) -> list[tuple[float, float]]:
    """Return begin and end (s) of each part of a record beside some stretches between peaks."""
    begins = [0, *(last for _, last in stretches)]
    ends = [*(first for first, _ in stretches), len(edges) - 1]
    return [(float(edges[a]), float(edges[b])) for a, b in zip(begins, ends, strict=True) if a < b]


def _smaller_cycles(its: Larger, begin: float, end: float) -> CycleCorners | None:
    """Return the cycles that are found in a stretch (s) by itself, if it has any of its own."""
    first, last = np.searchsorted(its.time, [begin, end])
    time, force = its.time[first:last], its.force[first:last]
    if len(force) == len(its.force) or len(force) < FEW_CYCLES * FEWEST_PER_CYCLE:
        return None
    smaller = find_corners(time, force, turning_points(force))
    if not _goes_on(smaller, float(time[0]), float(time[-1])):
        return None
    beside = [(a, min(b, begin)) for a, b in its.parts] + [(max(a, end), b) for a, b in its.parts]
    beside = [each for each in beside if each[0] < each[1]]
    beside.sort(key=lambda part: max(part[0] - end, begin - part[1]))  # the nearest first
    less = np.median(smaller.drop) < np.median(its.cycles.drop)
    return smaller if less and not _is_ripple(smaller, its, beside) else None


def _are_alike(drop: Floats) -> bool:
    """Return whether most drops (N) are about as large as the next one."""
    return len(drop) > 1 and bool(np.median(np.abs(np.diff(np.log(drop)))) <= CHANGED)


def _limit(smaller: CycleCorners, larger: CycleCorners) -> float:
    """Return the drop that separates smaller from larger cycles, N."""
    return float(np.sqrt(np.median(smaller.drop) * abs(np.median(larger.drop))))


def _extent(
    whole: CycleCorners, smaller: CycleCorners, first: int, last: int, least: int
) -> tuple[int, int]:
    """Return the indices of the peaks around smaller cycles, moved outwards over further ones.

    `first` and `last` are around those that were found, none before `least` is asked for.
    """
    small = np.concatenate([[False], whole.drop < _limit(smaller, whole), [False]])
    while first > least and small[first]:
        first -= 1
    while small[last]:
        last += 1
    return first, last


def _goes_on(cycles: CycleCorners, begin: float, end: float) -> bool:
    """Return whether several cycles are alike in size, and rise for longer than they fall.

    They neither die out until the end (s) of a stretch, nor build up from its begin (s).
    """
    if len(cycles.drop) < FEW_CYCLES or cycles.drop.min() <= 0.0:
        return False
    if np.median(cycles.rise_share) <= RISING or not _are_alike(cycles.drop):
        return False
    drop, period, corner = cycles.drop, cycles.period, cycles.corners.time
    builds_up = dies_out(drop[::-1], period[::-1], float(corner[0]) - begin)
    return not builds_up and not dies_out(drop, period, end - float(corner[-1]))


def _is_ripple(cycles: CycleCorners, its: Larger, parts: list[tuple[float, float]]) -> bool:
    """Return whether cycles go on beside larger ones, in parts of these (s), as ripple does.

    Parts are looked at in their order until they have enough periods.
    """
    least, period = AS_HIGH * float(np.median(cycles.drop)), float(np.median(cycles.period))
    most = _limit(cycles, its.cycles)
    found = expected = 0.0
    for begin, end in parts:
        if expected > ENOUGH:
            break
        first, last = np.searchsorted(its.time, [begin, end])
        force = its.force[first:last]
        number = float(np.ptp(its.time[first:last])) / period if len(force) else 0.0
        if number > 1.0:
            means = part_means(force, min(int(MEANS * number), len(force)))
            # on a steep slow motion a ripple does not turn back
            quick = means - uniform_mean(means, round(len(means) / number))
            height = all_heights(as_counts(quick)) * (np.ptp(quick) / COUNTS)
            found += np.count_nonzero((height > least) & (height < most))
            expected += number
    return found > AS_MANY * expected
