"""Hysteresis: the loops of force over travel in a reversal test."""

from __future__ import annotations

from dataclasses import dataclass
from math import isnan, nan, pi
from typing import NamedTuple

import numpy as np

from stiction.analysis.protocols.friction_test import FrictionTest, friction_test, without_harmonics
from stiction.analysis.record import Record
from stiction.analysis.signals.reversals import remove_reversals
from stiction.arrays import Floats, ShortRepr
from stiction.drive import ConstantVelocity, DriveProgram, drive_stretches
from stiction.errors import ResultError
from stiction.recording.noise import seeming_motion
from stiction.text.lists import in_list, number_text
from stiction.text.quantity.wording import in_words
from stiction.text.sections import Section, SectionReport, Table
from stiction.trajectory import Trajectory

NO_WAY = 1e-9  # of a drive's travel: no way there and back
FEWEST_SAMPLES = 20  # samples of a loop: an ellipse through them has 1.6 % less area
A_TURN = 8  # times in each turn of a harmonic at which turns of the drive are looked for
MOST_TIMES = 1e6  # such times between two jumps
LATE = 0.2  # of the width, for which the mass slides before the drive turns
VARIES = 0.01  # of the load: where it varies by more, a force over it is not a coefficient


@dataclass(frozen=True, repr=False)
class Loop(ShortRepr):
    """One loop, from a turn of the drive to the second turn after it, or to the record's end.

    Attributes
    ----------
    travel, force : ndarray
        (n,), displacement of the drive since the turn, m, harmonics included; force along the load
        cell, N.
    area : float
        The integral of the force over the travel, J: where the cell lies along the drive, the work
        of the drive per loop.
    width : float
        Distance between both branches at the middle force, m.
    friction : float
        Half of the distance between the mean forces of both branches where they end, over the
        normal load; half of the span of the force if the loop is not closed. NaN where the load
        varies.
    closed : bool
        Whether the drive ends where it began.
    """

    travel: Floats
    force: Floats
    area: float
    width: float
    friction: float
    closed: bool = True


@dataclass(frozen=True, repr=False)
class Hysteresis(SectionReport, ShortRepr):
    """The loops of a reversal test.

    Attributes
    ----------
    loops : tuple of Loop
        In order of time.
    left_out : tuple of str
        How many loops are left out, and why, in a sentence.
    """

    _figure = "plot_hysteresis"

    loops: tuple[Loop, ...]
    left_out: tuple[str, ...] = ()

    @property
    def section(self) -> Section:
        """The loops in words and as a table."""
        last = self.loops[-1]
        said = f"The last of {len(self.loops)} loops has an area of {in_words(last.area, 'J')}."
        if len(self.loops) == 1:
            said = f"The loop has an area of {in_words(last.area, 'J')}."
        rows = [
            (
                str(n),
                in_words(each.area, "J"),
                in_words(each.width, "m"),
                number_text(each.friction, ".4f"),
            )
            for n, each in enumerate(self.loops, 1)
        ]
        headings = ("loop", "area", "width", "half height over load")
        open_ones = [f"loop {n}" for n, each in enumerate(self.loops, 1) if not each.closed]
        sentences = [said, *self.left_out]
        if open_ones:
            sentences.append(
                f"Not closed, since the drive ends elsewhere than it began: {in_list(open_ones)}. "
                "Such an area is that of all of the way."
            )
        return Section("Hysteresis", sentences, Table(headings, rows))


def hysteresis(source: Trajectory | Record, program: DriveProgram | None = None) -> Hysteresis:
    """Return the loops of force over travel in a reversal test.

    With constant friction mu W on a spring of stiffness k, a loop between turns L apart has the
    area 2 mu W (L - 2 mu W/k), and the width L - 2 mu W/k.

    The drive may turn by jumps, ramps, harmonics or as it was recorded, and rest between. Turns of
    a harmonic that lies on a program are none of the test, unless the program does not move by
    itself.

    Parameters
    ----------
    source : Trajectory or Record
        A run, or a record with its normal load.
    program : DriveProgram, optional
        The program of a record, see `st.protocols.reversal_loops`; that of a run is known. Without
        it the record's `drive_position` counts.

    Raises
    ------
    ResultError
        If the drive does not turn twice.

    Examples
    --------
    >>> import stiction as st
    >>> test = st.protocols.reversal_loops("1 mm/s", "10 mm")
    >>> slider = st.presets.nakano_popov_2020().replace(friction=st.Coulomb(mu_0=0.2), drive=test)
    >>> found = st.analysis.hysteresis(st.simulate(slider, sample_rate="100 Hz"))
    >>> round(1e3 * found.loops[-1].area, 1)
    24.2
    """
    test, way = _test(source, program)
    turns = _turns(way)
    starts = range(0, len(turns) - 2, 2)
    loops = [_loop(test, way, turns[i], turns[i + 1], turns[i + 2]) for i in starts]
    found = [each for each in loops if each is not None]
    few = len(loops) - len(found)
    said = (f"Of fewer than {FEWEST_SAMPLES} samples, and left out: {few} of {len(loops)} loops.",)
    if loops and not found:
        raise ResultError(f"no loop has {FEWEST_SAMPLES} samples; raise the sample rate")
    if not found:
        raise ResultError("the drive does not turn twice; see st.protocols.reversal_loops")
    return Hysteresis(tuple(found), said if few else ())


class _Way(NamedTuple):
    """The way of the drive along X, by its program or as it was measured."""

    # s and m, so densely that no turn is missed
    time: Floats
    X: Floats
    sampled: Floats  # X at the samples of the force, m
    stirs: float = 0.0  # how far the drive goes back and forth beside the test, m
    noise: float = 0.0  # how far a measured drive may seem to move at rest, m


class _Turn(NamedTuple):
    """A turn of the drive: when it comes there and leaves (s), and where that is (m)."""

    comes: float
    leaves: float
    X: float


def _test(source: Trajectory | Record, program: DriveProgram | None) -> tuple[FrictionTest, _Way]:
    """Return the test, and the way of its drive: by the program before the measured one."""
    if program is None and isinstance(source, Record) and source.drive_position is not None:
        X = source.drive_position
        test = friction_test(source, DriveProgram())  # whose stretches a loop does not ask for
        return test, _Way(test.time, X, X, noise=seeming_motion(X))
    test = friction_test(source, program)
    time = _times(test)
    if not len(time):  # the record ends before the drive begins
        return test, _Way(time, time, test.time)
    X = np.broadcast_to(test.drive.travel(0.0, time)[0], time.shape)
    sampled = np.broadcast_to(test.drive.travel(0.0, test.time)[0], test.time.shape)
    return test, _Way(time, X, sampled, _stirs(test.drive, time))


def _turns(way: _Way) -> list[_Turn]:
    """Return the turns of the drive while it is recorded, and the end of its last way."""
    time, X = way.time, way.X
    if not len(time):
        return []
    least = max(way.stirs, way.noise, NO_WAY * float(np.ptp(X)))
    points, _ = remove_reversals(X, least)
    ways = np.flatnonzero(np.abs(np.diff(X[points])) > least)
    if not len(ways):
        return []
    at = [_stay(X, int(p), way.noise) for p in points[ways[0] + 1 : ways[-1] + 2]]
    if way.noise:  # it turns in the middle of what the noise hides, or the record ends meanwhile
        middles = [j if j == len(X) - 1 else (i + j) // 2 for i, j in at]
        at = list(zip(middles, middles, strict=True))
    return [_Turn(float(time[i]), float(time[j]), float(X[i])) for i, j in at]


def _stay(X: Floats, at: int, near: float) -> tuple[int, int]:
    """Return the first and the last sample of a stay at X[at], at most `near` from it."""
    away = np.flatnonzero(np.abs(X - X[at]) > near)
    i = int(np.searchsorted(away, at))
    first = int(away[i - 1]) + 1 if i else 0
    return first, int(away[i]) - 1 if i < len(away) else len(X) - 1


def _times(test: FrictionTest) -> Floats:
    """Return the times of the samples and of jumps, and enough more that no turn is missed (s)."""
    first, last = max(0.0, float(test.time[0])), float(test.time[-1])
    times, start = [test.time[test.time >= first]], 0.0
    for end, course in drive_stretches(test.drive):
        begin, until = max(start, first), min(end, last)
        start = end
        if until > begin:
            turns = 0.0 if course.steady() else course.along.fastest() * (until - begin) / (2 * pi)
            times.append(np.linspace(begin, until, int(min(A_TURN * turns, MOST_TIMES)) + 2))
    return np.unique(np.concatenate(times))


def _stirs(drive: ConstantVelocity | DriveProgram, time: Floats) -> float:
    """Return how far a harmonic on top of a program goes back and forth by itself, m."""
    if isinstance(drive, ConstantVelocity) or drive.along is None:
        return 0.0
    if not np.ptp(without_harmonics(drive).travel(0.0, time)[0]) > 0.0:
        return 0.0  # the harmonic is the test
    return abs(float(drive.along.amplitude)) / (pi * float(drive.along.frequency)) * (1.0 + NO_WAY)


def _loop(test: FrictionTest, way: _Way, first: _Turn, middle: _Turn, second: _Turn) -> Loop | None:
    """Return the loop between two turns; None if it has too few samples."""
    at = test.within(first.leaves, second.comes)
    if len(at) < FEWEST_SAMPLES:
        return None
    time, force, load = test.time[at], test.force[at], test.load[at]
    travel = way.sampled[at] - first.X
    step = float(np.abs(np.diff(travel)).max())  # by which the last sample may come too early
    closed = abs(second.X - first.X) <= way.stirs + way.noise + step
    turned = time > middle.comes
    level = 0.5 * (force.max() + force.min())
    ahead = np.sign(force[~turned].mean() - force[turned].mean())
    sides = [
        _crossing(travel[part], sign * (force[part] - level))
        for part, sign in ((~turned, ahead), (turned, -ahead))
    ]
    area = abs(float(np.trapezoid(force, travel)))
    mean = float(load.mean())
    width, height = abs(sides[1] - sides[0]), float(np.ptp(force))
    if closed and not isnan(width):
        ends = [
            float(force[part][np.abs(travel[part] - travel[part][-1]) <= LATE * width].mean())
            for part in (~turned, turned)
        ]
        height = abs(ends[0] - ends[1])
    friction = 0.5 * height / mean if np.ptp(load) <= VARIES * mean else nan
    return Loop(travel, force, area, width, friction, closed)


def _crossing(travel: Floats, above: Floats) -> float:
    """Return where a branch first gets above a level, between samples by a straight line."""
    passed = np.flatnonzero(above >= 0.0)
    if not len(passed):
        return nan
    i = int(passed[0])
    if i == 0:  # the drive turns and passes the level within a sample
        return float(travel[0])
    share = above[i] / (above[i] - above[i - 1])
    return float(travel[i] - share * (travel[i] - travel[i - 1]))
