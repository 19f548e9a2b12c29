"""Rules for the kind of motion of a run, whose samples have no noise.

An analysis and a study classify a run by these rules alone, however many samples it has. Without
noise one more rule than for measured records holds: a motion is over, even after only two swings,
if no other follows for long.
"""

from __future__ import annotations

from collections.abc import Callable
from math import hypot
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from stiction.analysis.motion.changes.cycles import BELOW, parts_of
from stiction.analysis.motion.course import Course, course_of_parts
from stiction.analysis.motion.noiseless.resolution import LATE, SHOWN_SAMPLES, rate_of_sticks
from stiction.analysis.motion.noiseless.swings import SwingShapes
from stiction.analysis.motion.regime.evidence import Evidence, Regime
from stiction.analysis.motion.regime.force_course import (
    FINAL_FALL,
    ONE_WAY,
    SETTLED,
    SLOW,
    STILL_STICKS,
)
from stiction.analysis.motion.regime.kinds import (
    HARMONIC,
    IRREGULAR,
    SETTLING,
    STEADY,
    STICK_SLIP,
    STUCK,
    TRANSVERSE,
    UNDETERMINED,
    couples,
    shape,
)
from stiction.analysis.motion.rest import (
    TOUCHES,
    stick_shares,
    still_shares,
    stops_with_drive,
    stuck_share,
)
from stiction.analysis.motion.vibration import LEAST_OSCILLATION, FastOscillation, is_irregular
from stiction.arrays import Floats, median
from stiction.drive.program import nominal_velocity
from stiction.system.slider import Slider

if TYPE_CHECKING:  # else numba would be loaded for a measured record, too
    from stiction.analysis.motion.noiseless.features import Features

# Times the speed at most of a mass that does not slip, though it swings across the drive: along the
# stiffer axis twice the drive's, unless its slip reverses (Nakano & Popov, below Eq. (9))
SLIPS = 1.5
PER_PART = 16  # times of each part of a run, over which its load is averaged


class Circumstances(NamedTuple):
    """Further conditions on which the kind of a run's motion depends.

    Parameters
    ----------
    slider : Slider
        The system.
    begin, end : float
        Of the run, s.
    until : float
        When drive or load change after the last swing, or else the end, s.
    loading : float
        Rate of the force while the mass sticks: stiffness times drive velocity, N/s.
    stops : bool
        Whether drive and mass rest at the end.
    slip : float
        Largest slip speed over the drive's; 0 where that rests.
    sticks : ndarray
        All stick intervals, (k, 2), s.
    """

    slider: Slider
    begin: float
    end: float
    until: float
    loading: float
    stops: bool
    slip: float
    sticks: Floats

    @classmethod
    def of(
        cls, slider: Slider, time: Floats, swings: SwingShapes, loading: float,
        slip_speed: Floats, sticks: Floats,
    ) -> Circumstances:  # fmt: skip
        """Return those of a run with some times (s), swings, slip speeds (m/s) and sticks (s)."""
        begin, end = float(time[0]), float(time[-1])
        until = end
        if len(swings.start):
            until = min(end, slider.steady_until(float(swings.start[-1])))
        stops = stops_with_drive(slider.motion, end, slip_speed)
        V = abs(nominal_velocity(slider.motion))
        slip = float(slip_speed.max()) / V if V else 0.0
        return cls(slider, begin, end, until, loading, stops, slip, sticks)


def kind_of_cycles(
    cycles: SwingShapes,
    own: float,
    still: Callable[[SwingShapes], Floats],
    sticks: Callable[[SwingShapes], Floats],
    beats: Callable[[], object],
) -> str:
    """Return the kind of a run's cycles; of parts whose periods differ, that of the longest.

    `own` is the period of the mass on the spring along x alone (s); the shares of each cycle for
    which the mass rests or creeps, and sticks, and whether two lines beat, are asked for.
    """
    parts = [cycles.some(part) for part in parts_of(cycles.period)]
    longest = max(parts, key=lambda part: float(part.period.sum()))
    rise = median(longest.rise_share)
    kind = shape(rise)
    if couples(kind, float(longest.period.mean()), own):
        return TRANSVERSE
    if kind != STICK_SLIP:  # rest, where there is any, makes it one
        kind = shape(rise, *(median(share(longest)) for share in (still, sticks)))
    irregular = kind == HARMONIC and is_irregular(longest.period, longest.drop)
    return IRREGULAR if irregular and not beats() else kind


def settle(swings: SwingShapes, given: Circumstances) -> bool:
    """Return whether swings die out, or end at rest where the drive never moves."""
    if swings.die_out(given.until):
        return True
    ended = given.stops and not nominal_velocity(given.slider.motion) and len(swings.drop) > 0
    return ended and bool(swings.drop[-1] <= swings.drop[0])


def regime_without_cycles(
    found: Features, swings: SwingShapes, given: Circumstances, fast: Callable[[], FastOscillation]
) -> Regime:
    """Return the kind of a run's motion without cycles, from its swings and its course.

    `fast` is asked for the fast oscillation at the end, where all else has settled.
    """
    drop, last = swings.drop, (0.0, 1.0)
    if settle(swings, given):
        name: Evidence = "swings"
        if swings.are_over(given.until) and drop[-1] > BELOW * drop.max():
            name = "over"
        sure = (len(drop) + 1) / (len(drop) + 3)
        seen = Regime(SETTLING, sure, {name: len(drop), "last_over_first": drop[-1] / drop[0]})
        last = (float(drop[-1]), float(swings.period[-1]))
    else:
        seen = by_course(found, given)
        if len(drop):
            over: dict[Evidence, float] = {"over": len(drop)}
            seen = seen._replace(evidence=over | seen.evidence)
    if seen.kind not in (SETTLING, STEADY) or given.stops:
        return seen
    its = fast()
    if its.goes_on(*last):
        sure = 1.0 - 0.5 * LEAST_OSCILLATION / its.amplitude  # at the bound either is as likely
        return Regime(TRANSVERSE, sure, seen.evidence | {"across": its.amplitude}, seen.kind)
    return _unless_it_sticks(seen, given)


def by_course(found: Features, given: Circumstances) -> Regime:
    """Return the kind of a run's force without cycles, from its course."""
    places = np.linspace(given.begin, given.end, len(found.means), endpoint=False)
    way, settled = course_of_parts(places, found.means), 0.0
    evidence: dict[Evidence, float] = {"change": way.change, "span": way.span}
    if given.loading:
        evidence["rate_over_drive"] = way.late_rate / given.loading
    if given.stops:
        return Regime(SETTLING, 1.0, evidence | {"stops": given.end})
    if way.span > 0.0 and way.late_span <= SETTLED * way.span:
        late = way.late_span / way.span
        return Regime(SETTLING, 1.0 - late / (2.0 * SETTLED), evidence | {"late_share": late})
    settled = SETTLED * way.span
    force = np.array([found.first, *found.turn_value, found.last])
    fallen = np.maximum.accumulate(force) - force
    if fallen.max() > settled:
        return Regime(UNDETERMINED, 0.0, evidence | {"turns": len(found.turn_value)})
    rising = _rises(way) and _rises(course_of_parts(places, _under_one_load(found.means, given)))
    if not rising or _is_slow(way, given):
        sure = 1.0 - 0.5 * float(fallen.max()) / settled if settled else 1.0
        return Regime(STEADY, sure, evidence)
    if fallen[-1] > fallen[:-1].max():  # a slip ends the run
        top = int(np.argmax(force)) - 1
        falls = float(found.turn_time[top]), float(fallen[-1])
        return Regime(UNDETERMINED, 0.0, evidence | dict(zip(FINAL_FALL, falls, strict=True)))
    return _loading(way, given, evidence)


def _rises(way: Course) -> bool:
    return way.change > 0.0 and way.one_way >= ONE_WAY


def _under_one_load(means: Floats, given: Circumstances) -> Floats:
    """Return a force over its load: friction grows with the load, a spring does not."""
    if given.slider.load is None:
        return means
    times = np.linspace(given.begin, given.end, PER_PART * len(means))
    load = given.slider.weight(times).reshape(len(means), PER_PART).mean(axis=1)
    return np.asarray(means * np.where(load > 0.0, given.slider.normal_load / load, 1.0))


def _is_slow(way: Course, given: Circumstances) -> bool:
    """Return whether a force changes so slowly that the mass goes with the drive."""
    return 0.0 < max(abs(way.early_rate), abs(way.late_rate)) < SLOW * given.loading


def _loading(way: Course, given: Circumstances, evidence: dict[Evidence, float]) -> Regime:
    """Return that the mass is stuck if its spring goes on being loaded, and it never slips."""
    kept = way.late_rate / way.early_rate if way.early_rate else np.inf
    evidence = evidence | {"one_way": way.one_way, "rate_kept": kept}
    loading = way.late_rate / given.loading if given.loading else kept
    along, across = given.slider.direction
    if given.slip > SLIPS * hypot(along, 2.0 * across):
        return Regime(UNDETERMINED, 0.0, evidence | {"fastest_slip": given.slip})
    if loading < STILL_STICKS:
        return Regime(UNDETERMINED, 0.0, evidence)
    return Regime(STUCK, way.one_way * min(loading, 1.0), evidence)


def _unless_it_sticks(seen: Regime, given: Circumstances) -> Regime:
    """Return that nothing is determined of a run whose many sticks to its end show no cycles."""
    begin = given.end - LATE * (given.end - given.begin)
    if given.slider.steady_until(begin) < given.end:
        return seen
    return many_sticks(given.begin, given.end, given.sticks) or seen


def many_sticks(begin: float, end: float, sticks: Floats) -> Regime | None:
    """Return that nothing is determined of a run that sticks again and again to its end (s).

    Its samples are too few to show the cycles.
    """
    needed, first = rate_of_sticks(begin, end, sticks), end - LATE * (end - begin)
    share = stuck_share(first, end, sticks)
    if not needed or share <= TOUCHES:
        return None
    count = round(needed * (end - first) / SHOWN_SAMPLES)
    return Regime(
        UNDETERMINED, 0.0, {"late_sticks": count, "stick_share": share, "rate_needed": needed}
    )


def rest_of(cycles: SwingShapes, time: Floats, speed: Floats) -> Floats:
    """Return the share of each cycle in which the mass rests or creeps, in one piece.

    The speed (n,) is that of slip over that of the drive.
    """
    return still_shares(time, speed, cycles.start, cycles.peak_time, cycles.period)


def sticks_of(cycles: SwingShapes, sticks: Floats) -> Floats:
    """Return the share of each cycle in which the mass sticks."""
    return stick_shares(sticks, cycles.start, cycles.peak_time, cycles.period)
