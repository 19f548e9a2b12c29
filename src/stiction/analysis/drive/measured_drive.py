"""Stretches of constant velocity of a drive whose displacement was measured.

Where the displacement bends is sought from the whole to its parts: at the point that is farthest
from the chord, as long as that is farther than noise (U. Ramer, Comput. Graph. Image Process. 1,
244 (1972); D. H. Douglas & T. K. Peucker, Cartographica 10, 112 (1973)). Neighbouring lines through
all samples cross where the velocity jumps, to a fraction of a sample.
"""

from __future__ import annotations

from itertools import pairwise
from math import inf
from typing import NamedTuple

import numpy as np

from stiction.analysis.signals.correlated_noise import ERRORS_997, standard_error
from stiction.analysis.signals.digitised import resolution
from stiction.analysis.signals.robust import part_means
from stiction.analysis.signals.straight_line import StraightLine, line
from stiction.arrays import Floats
from stiction.drive import ConstantVelocity, Stretches
from stiction.errors import ResultError
from stiction.recording.noise import seeming_motion, white_noise
from stiction.text.quantity.wording import SLIGHT

MEANS = 4000  # of the record, at most: noise is averaged out
FEWEST_MEANS = 3.0  # over which a velocity lasts: a bend is not better placed
# Of the whole way: a deviation from a chord that is less shows no bend, and a way that is less rest
BENDS = 1e-3
BRIEF = 0.1  # of a neighbour, in time and way: a drive takes less from one velocity to the next
SAME = 0.01  # of a velocity: a program has the same twice
SAG = 0.1  # of the deviation that makes a bend: means of a part that spread by more are not a line
CERTAIN = 6.0  # errors of a mean: eight means of noise spread by more once in a thousand
BENT_SHARE = 0.3  # of the record: where more is bent the drive swings, and keeps to no velocity
RESTS = 0.02  # of the speed of a drive: a slope that is less is that of noise
GOES = 0.9  # of the reach of a displacement: a drive that goes less far on the whole is noise
FEWEST_SAMPLES = 6  # of a motion, by fewer its speed is not known
SAGS = 8  # means of a part that show it
PACES = 16  # parts of a record, whose speeds show whether a drive keeps to one
UNEVEN = 0.1  # of the median of these speeds: by so much they differ where it does not


class _Part(NamedTuple):
    """A part of the record with its line: from one time to another, s; whether it is bent."""

    start: float
    end: float
    line: StraightLine
    bent: bool

    @property
    def duration(self) -> float:
        return self.end - self.start

    @property
    def way(self) -> float:
        return self.duration * abs(self.line.slope)


def measured_stretches(time: Floats, position: Floats) -> Stretches:
    """Return the stretches of constant velocity of a drive: the end of each (s), and its velocity.

    A brief change from one velocity to the next counts as a jump.

    A ResultError is raised where the drive does not keep to any velocity.
    """
    parts = _without_brief(_parts(time, position), (time[-1] - time[0]) / min(len(time), MEANS))
    bent = sum(each.duration for each in parts if each.bent)
    if bent > BENT_SHARE * (time[-1] - time[0]):
        raise ResultError(
            "the measured displacement of the drive has no stretches of constant velocity; give "
            "the program of the test"
        )
    least = BENDS * float(np.ptp(position))
    speeds = np.array([each.line.slope if each.way > least else 0.0 for each in parts])
    speeds = _alike(speeds, np.array([each.duration for each in parts]))
    ends = [*(_crossing(one, two) for one, two in pairwise(parts)), inf]
    lasts = np.append(speeds[1:] != speeds[:-1], True)  # of neighbours that are alike
    return tuple(
        (end, ConstantVelocity._make((float(speed),)))
        for end, speed, last in zip(ends, speeds, lasts, strict=True)
        if last
    )


class EvenDrive(NamedTuple):
    """The speed of a drive that keeps to one, and its standard error, m/s."""

    speed: float
    error: float

    def agrees(self, speed: float) -> bool:
        """Return whether a stated speed (m/s) is the same, within the error or a thousandth.

        >>> EvenDrive(1e-3, 1e-6).agrees(1.001e-3), EvenDrive(1e-3, 1e-5).agrees(1.02e-3)
        (True, True)
        >>> EvenDrive(1e-3, 1e-6).agrees(1.004e-3)
        False
        """
        return abs(speed - self.speed) <= max(ERRORS_997 * self.error, SLIGHT * self.speed)


def even_drive(time: Floats, position: Floats) -> EvenDrive | None:
    """Return the speed of a drive that keeps to one; None if it does not.

    It may rest before it starts, and after it stops, but not turn, pause or change its velocity.
    Noise must leave its speed known.
    """
    try:
        its = measured_stretches(time, position)
    except ResultError:
        return None
    begins = [float(time[0]), *(end for end, _ in its[:-1])]
    speeds = [abs(drive.velocity) for _, drive in its]
    moves = [at for at, speed in enumerate(speeds) if speed > RESTS * max(speeds)]
    if len(moves) != 1 or len(its) > 3:
        return None
    (at,) = moves
    end = min(its[at][0], float(time[-1]))
    inside = slice(*np.searchsorted(time, [begins[at], end]))
    if inside.stop - inside.start < FEWEST_SAMPLES:
        return None
    way = line(time[inside], position[inside])
    speed, off = abs(way.slope), way.deviations(time[inside], position[inside])
    error = standard_error(off) / float(time[inside].std())
    goes = speed * (end - begins[at]) > GOES * float(np.ptp(position))
    return EvenDrive(speed, error) if error < SAME * speed and goes else None


def uneven_speeds(time: Floats, position: Floats) -> tuple[float, float] | None:
    """Return the least and the largest speed (m/s) of a drive that goes one way; None if even.

    They are means over parts of the record, and differ by more than noise.

    >>> time = np.linspace(0.0, 10.0, 1001)
    >>> uneven_speeds(time, 1e-3 * time), uneven_speeds(time, np.sin(time))
    (None, None)
    >>> [round(speed, 2) for speed in uneven_speeds(time, time**2)]
    [1.24, 18.75]
    """
    if len(time) < FEWEST_SAMPLES * PACES:
        return None
    when, where = part_means(time, PACES), part_means(position, PACES)
    paces = np.diff(where) / np.diff(when)
    speeds = np.abs(paces)
    noise = white_noise(position) * (2.0 * PACES / len(time)) ** 0.5 / float(np.diff(when).min())
    least = max(UNEVEN * float(np.median(speeds)), CERTAIN * noise)
    turns = paces.min() < -least and paces.max() > least
    return None if turns or np.ptp(speeds) <= least else (float(speeds.min()), float(speeds.max()))


def _parts(time: Floats, position: Floats) -> list[_Part]:
    """Return the parts of a record between bends of the displacement, each with its line."""
    times, places = part_means(time, MEANS), part_means(position, MEANS)
    code = resolution(position)
    far = max(seeming_motion(places), BENDS * float(np.ptp(places)), code)
    bends = times[_bends(times, places, far)]
    edges = [float(time[0]), *bends[1:-1].tolist(), float(time[-1])]
    return [_part(time, position, *each, max(SAG * far, code)) for each in pairwise(edges)]


def _bends(times: Floats, places: Floats, far: float) -> list[int]:
    """Return the ends, and the points between them at which a polygon is nowhere `far` off."""
    found, todo = {0, len(times) - 1}, [(0, len(times) - 1)]
    while todo:
        first, last = todo.pop()
        if last - first < 2:
            continue
        share = (times[first : last + 1] - times[first]) / (times[last] - times[first])
        chord = places[first] + share * (places[last] - places[first])
        off = np.abs(places[first : last + 1] - chord)
        at = first + int(off.argmax())
        if off[at - first] > far:
            found.add(at)
            todo += [(first, at), (at, last)]
    return sorted(found)


def _part(time: Floats, position: Floats, start: float, end: float, least: float) -> _Part:
    """Return a part with the line through its samples, except the samples at its ends.

    It is bent if means spread about the line by `least` (m), and by more than their noise.
    """
    inside = slice(*np.searchsorted(time, [start, end]))
    cut = (inside.stop - inside.start) // 10
    inside = slice(inside.start + cut, max(inside.stop - cut, inside.start + 2))
    when, place = time[inside], position[inside]
    found = line(when, place)
    off = part_means(found.deviations(when, place), SAGS) if len(when) else when
    error = white_noise(place) * (SAGS / max(len(place), 1)) ** 0.5
    bent = len(off) == SAGS and float(np.ptp(off)) > max(least, CERTAIN * error)
    return _Part(start, end, found, bent)


def _without_brief(parts: list[_Part], interval: float) -> list[_Part]:
    """Return parts without brief transitions between two velocities, the briefest removed first.

    In a transition the drive passes from one velocity to the next, in little time and travel. A
    part that is faster than both neighbours, or slower, is one of the test, if it lasts over some
    means at an `interval` (s).
    """
    parts, least = list(parts), FEWEST_MEANS * interval
    while True:
        brief = [
            (two.duration, at)
            for at, (one, two, three) in enumerate(
                zip(parts, parts[1:], parts[2:], strict=False), start=1
            )
            if two.duration < least
            or (
                two.duration < BRIEF * max(one.duration, three.duration)
                and two.way < BRIEF * max(one.way, three.way)
                and (two.line.slope - one.line.slope) * (three.line.slope - two.line.slope) >= 0.0
            )
        ]
        if not brief:
            return parts
        del parts[min(brief)[1]]


def _alike(speeds: Floats, durations: Floats) -> Floats:
    """Return velocities, with those that differ by little replaced by their mean.

    The variance of a slope falls with the cube of its duration.
    """
    found = speeds.copy()
    order = np.argsort(np.abs(found))
    sizes = np.abs(found)[order]
    groups = np.cumsum(np.diff(sizes, prepend=sizes[0]) > SAME * sizes)
    for group in np.unique(groups):
        here = order[groups == group]
        mean = np.average(np.abs(found[here]), weights=durations[here] ** 3)
        found[here] = np.sign(found[here]) * float(mean)
    return found


def _crossing(one: _Part, two: _Part) -> float:
    """Return the time at which the lines of two parts cross, s: between their middles."""
    by = one.line.slope - two.line.slope
    if not by:
        return 0.5 * (one.end + two.start)
    at = one.start + (two.line.at(one.start) - one.line.at(one.start)) / by
    low, high = one.start + 0.5 * one.duration, two.start + 0.5 * two.duration
    return min(max(float(at), low), high)
