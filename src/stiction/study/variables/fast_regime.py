"""Classification of a simulated run's motion from the features of its noise-free samples.

The kinds and their bounds are those of `stiction.analysis.motion.regime`, which also classifies
noisy records but takes a hundred times as long; a test keeps the two consistent. Without noise
one more rule holds: a motion is over, even after only two swings, if no other follows for long.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from stiction.analysis.motion.changes.cycles import built_up
from stiction.analysis.motion.course import course_of_parts, dies_out, is_over
from stiction.analysis.motion.hesitations import cycle_corners
from stiction.analysis.motion.regime import force_course, kinds
from stiction.analysis.motion.vibration import FastOscillation, is_irregular
from stiction.arrays import Floats, median
from stiction.study.variables.features import Features

KINDS = (
    kinds.UNDETERMINED,
    kinds.STUCK,
    kinds.STICK_SLIP,
    kinds.TRANSITIONAL,
    kinds.HARMONIC,
    kinds.SETTLING,
    kinds.STEADY,
    kinds.TRANSVERSE,
    kinds.IRREGULAR,
)  # stores keep their indices: append new ones
FORMERLY = {
    "between stick-slip and harmonic vibration": kinds.TRANSITIONAL,
    "damped approach": kinds.SETTLING,
    "song": kinds.TRANSVERSE,
}


class SwingShapes(NamedTuple):
    """Complete swings of the force, from trough over peak to trough, (n,) each.

    Parameters
    ----------
    drop : ndarray
        From peak to trough, N.
    period : ndarray
        From trough to trough, s.
    rise_share : ndarray
        Fraction of the period in which the force rises.
    end : float
        Time of the last trough, s.
    """

    drop: Floats
    period: Floats
    rise_share: Floats
    end: float

    @property
    def start(self) -> Floats:
        """Time of the trough before each swing, s."""
        return np.asarray(self.end - np.cumsum(self.period[::-1])[::-1])

    def die_out(self, until: float) -> bool:
        """Return whether the swings die out until a time (s): a transient, not cycles."""
        return dies_out(self.drop, self.period, until - self.end)

    def some(self, which: slice) -> SwingShapes:
        """Return a subset."""
        end = self.end - float(self.period[which.stop :].sum())
        return SwingShapes(self.drop[which], self.period[which], self.rise_share[which], end)


class Circumstances(NamedTuple):
    """Further conditions on which the kind of a run's motion depends.

    Parameters
    ----------
    duration, until : float
        Of the run, s; and when drive or load change after the last swing, or else the end.
    drive : float
        Rate of the force while the mass sticks: stiffness times drive velocity, N/s.
    own : float
        Period of the mass on the spring along x alone, s.
    stops : bool
        Whether drive and mass rest at the end.
    """

    duration: float
    until: float
    drive: float
    own: float
    stops: bool


# For which share of each of some swings the mass rests or creeps, and sticks
Shares = tuple[Callable[[SwingShapes], Floats], Callable[[SwingShapes], Floats]]


def swings(found: Features) -> SwingShapes:
    """Return the complete swings between turning points, without hesitations."""
    ends = found.first, found.last
    kept = cycle_corners(found.turn_value, found.turn_time, ends, found.trough).kept
    time, value = found.turn_time[kept], found.turn_value[kept]
    start, peak, trough = time[:-1:2], time[1::2], time[2::2]
    period, end = trough - start, float(trough[-1]) if len(trough) else 0.0
    return SwingShapes(value[1::2] - value[2::2], period, (peak - start) / period, end)


def kind_of(
    found: Features,
    complete: SwingShapes,
    cycles: SwingShapes,
    given: Circumstances,
    fast: FastOscillation,
    shares: Shares,
) -> str:
    """Return the kind of motion, from features, swings, cycles and the final fast oscillation.

    `complete` are all complete swings, of which `cycles_among` finds the cycles.
    """
    if len(cycles.drop):
        return by_shape(cycles, given.own, shares)
    dying = complete.die_out(given.until)
    kind = kinds.SETTLING if dying else by_course(found, given)
    last = (float(complete.drop[-1]), float(complete.period[-1])) if dying else ()
    slides = kind in (kinds.SETTLING, kinds.STEADY) and not given.stops
    return kinds.TRANSVERSE if slides and fast.goes_on(*last) else kind


def cycles_among(found: SwingShapes, until: float) -> SwingShapes:
    """Return the swings that are cycles by the rules of `stiction.analysis.find_cycles`."""
    none = is_over(found.period, until - found.end) or found.die_out(until)
    return found.some(slice(0, 0) if none else built_up(found.drop))


def by_shape(cycles: SwingShapes, own: float, shares: Shares) -> str:
    """Return the kind of cycles from their shape, size and period, and the rest in them."""
    rise = median(cycles.rise_share)
    kind = kinds.shape(rise)
    if kinds.couples(kind, float(cycles.period.mean()), own):
        return kinds.TRANSVERSE
    if kind != kinds.STICK_SLIP:  # rest, where there is any, makes it one
        kind = kinds.shape(rise, *(median(share(cycles)) for share in shares))
    irregular = kind == kinds.HARMONIC and is_irregular(cycles.period, cycles.drop)
    return kinds.IRREGULAR if irregular else kind


def by_course(found: Features, given: Circumstances) -> str:
    """Return the kind of a force without cycles, by the rules of `analysis.motion.regime`."""
    places = np.linspace(0.0, given.duration, len(found.means), endpoint=False)
    way, drive = course_of_parts(places, found.means), given.drive
    settled = force_course.SETTLED * way.span
    if given.stops or (way.span > 0.0 and way.late_span <= settled):
        return kinds.SETTLING
    force = np.array([found.first, *found.turn_value, found.last])
    fallen = np.maximum.accumulate(force) - force
    if fallen.max() > settled:
        return kinds.UNDETERMINED
    early, late = way.early_rate, way.late_rate
    rising = way.change > 0.0 and way.one_way >= force_course.ONE_WAY
    if not rising or 0.0 < max(abs(early), abs(late)) < force_course.SLOW * drive:
        return kinds.STEADY
    if fallen[-1] > fallen[:-1].max():  # a slip ends the run
        return kinds.UNDETERMINED
    loading = late / drive if drive else late / early
    return kinds.STUCK if loading >= force_course.STILL_STICKS else kinds.UNDETERMINED
