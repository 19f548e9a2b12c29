"""The zero of a force: whether it is stated, and the one that a record shows."""

from __future__ import annotations

from math import hypot, inf
from typing import Literal, NamedTuple

from stiction.analysis.motion.changes.initial_rest import NOISE, first_level, initial_rest
from stiction.analysis.motion.course import BEGINS_UNLOADED
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.friction import Friction
from stiction.analysis.motion.metadata.comparison import AT_REST
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import ERRORS_997
from stiction.analysis.signals.robust import largest_magnitude
from stiction.recording.origin import OriginOfStroke

ABOUT_ZERO = 0.05  # of half the drop: so far from zero the middle of a swing may lie


class ZeroShown(NamedTuple):
    """The force (N) that a record shows where it may be zero, and its standard error."""

    reading: float
    error: float
    # the rest before the first loading, the middle of the forces forth and back, or the reading
    # from which a force is loaded at once
    by: Literal["rest", "strokes", "start"]


def is_about_zero(friction: Friction, cycles: CycleTable) -> bool:
    """Return whether the mean friction is nearly nothing beside the swings, or the scatter."""
    mean = friction.kinetic
    if mean is None:
        return False
    swing = 0.5 * cycles.median("drop") if len(cycles) else mean.spread
    return abs(mean.force) < ABOUT_ZERO * swing


def trough_against(record: Record, friction: Friction, cycles: CycleTable) -> float | None:
    """Return the usual trough of stick-slip, N, if it is against the drive and no zero is stated.

    A mass slips as far below its kinetic friction as it was above: that would then be less than
    half of the static one.
    """
    if friction.static is None or record.zero is not None or not len(cycles):
        return None
    trough, swing = cycles.median("trough"), 0.5 * cycles.median("drop")
    against = trough < -ABOUT_ZERO * swing and cycles.median("peak") > ABOUT_ZERO * swing
    return trough if against else None


def why_no_friction(record: Record, friction: Friction, cycles: CycleTable) -> str:
    """Return why no force of a record is a friction, by its mean; empty if it may be one."""
    if friction.kinetic is None:
        return ""
    if is_about_zero(friction, cycles):
        return "the mean force is about zero, as no friction is"
    if friction.kinetic.force > 0.0 and trough_against(record, friction, cycles) is not None:
        return "the troughs are against the drive, and no zero is stated"
    return "the mean force is against the drive" if friction.kinetic.force < 0.0 else ""


def is_stated(record: Record) -> bool:
    """Return whether the zero of a force is stated, perhaps with its uncertainty."""
    return record.zero is not None or stated_error(record) > 0.0


def stated_error(record: Record) -> float:
    """Return the standard uncertainty of the zero at the first sample, N, as it is stated, or 0."""
    sensor = (record.sensors or {}).get("force")
    return 0.0 if sensor is None else sensor.zero_uncertainty


def zero_shown(record: Record, friction: Friction, cycles: CycleTable) -> ZeroShown | None:
    """Return the zero that a record shows where none is stated, if it is off."""
    if is_stated(record):
        return None
    start = reading_of_start(record, friction)
    return (
        _by_rest(record, friction, cycles)
        or _by_strokes(record)
        or (start if may_be_zero(start, friction) else None)
    )


def _by_rest(record: Record, friction: Friction, cycles: CycleTable) -> ZeroShown | None:
    """Return the rest with which a record begins, if its reading may be the zero.

    It may not where the force returns so low while the mass slips: then the drive paused, and the
    spring was loaded.
    """
    known = friction.break_away or friction.kinetic
    if known is None or known.force <= 0.0:
        return None
    rest = initial_rest(record.force, known.force)
    if rest is None or rest.reading > BEGINS_UNLOADED * known.force:
        return None
    lowest = float(cycles["trough"].min()) if len(cycles) else known.force
    return ZeroShown(*rest, "rest") if rest.reading < lowest else None


def place_of_stroke(record: Record) -> OriginOfStroke | None:
    """Return where a record stands among the strokes of its file, if it is one of them."""
    return None if record.origin is None else record.origin.stroke


def _by_strokes(record: Record) -> ZeroShown | None:
    """Return the middle of the forces forth and back, in the direction of a stroke, if it is off.

    It is the zero where friction is as large both ways.
    """
    stroke = place_of_stroke(record)
    if stroke is None or stroke.middle is None:
        return None
    error = stroke.middle_error or 0.0
    least = max(ERRORS_997 * error, AT_REST * largest_magnitude(record.force))
    if abs(stroke.middle) <= least:
        return None
    return ZeroShown(stroke.way * stroke.middle, error, "strokes")


def reading_of_start(record: Record, friction: Friction) -> ZeroShown | None:
    """Return the first reading of a force that rises from the first sample on, if it is off.

    It is the zero if the spring was unloaded, and nothing if it was loaded already. Where the
    record begins in the middle of a loading, or after a turn of the drive, it is neither.
    """
    stroke = place_of_stroke(record)
    if is_stated(record) or friction.break_away is None:
        return None
    if stroke is not None and stroke.after_turn:
        return None
    reading, noise = first_level(record.force)
    least = max(AT_REST * largest_magnitude(record.force), NOISE * noise)
    return ZeroShown(reading, noise, "start") if abs(reading) > least else None


def may_be_zero(start: ZeroShown | None, friction: Friction) -> bool:
    """Return whether a first reading is so small beside friction that it may be the zero."""
    top = friction.break_away
    if start is None or top is None:
        return False
    return abs(start.reading) <= BEGINS_UNLOADED * top.force


def is_hidden(record: Record, friction: Friction, shown: ZeroShown | None) -> bool:
    """Return whether a record begins with a loaded spring, and nothing else tells its zero."""
    known = friction.static or friction.kinetic or friction.break_away
    if known is None or is_stated(record) or shown is not None:
        return False
    if place_of_stroke(record) is not None:
        return False
    return abs(first_level(record.force)[0]) > BEGINS_UNLOADED * abs(known.force)


def shift_of_zero(
    record: Record, friction: Friction, cycles: CycleTable, shown: ZeroShown | None
) -> float:
    """Return by how much a zero that is off shifts friction, N; all of it if that is unreal."""
    if why_no_friction(record, friction, cycles):
        return inf
    return 0.0 if shown is None else abs(shown.reading)


def with_zero(friction: Friction, record: Record, shown: ZeroShown | None) -> Friction:
    """Return the friction with the errors that follow if the record's apparent zero is true.

    A correction is made for an effect that is known (GUM, 3.2.4: JCGM 100:2008). This one is not: a
    spring that friction holds reads as much. So the values are those of the zero as it is supposed,
    and the error reaches to those of the other zero. A stated zero has its stated uncertainty.
    """
    further = stated_error(record) if shown is None else hypot(shown.reading, shown.error)
    return friction.with_errors(break_away=further, static=further, kinetic=further)
