"""Doubts about the zero of a force: the evidence in the record, and its limits."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot, inf, isfinite

from stiction.analysis.motion.changes.initial_rest import (
    NOISE,
    InitialRest,
    first_level,
    initial_rest,
)
from stiction.analysis.motion.course import BEGINS_UNLOADED
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.friction import Friction, Measured
from stiction.analysis.motion.metadata.comparison import AT_REST
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import ERRORS_997
from stiction.analysis.signals.robust import largest_magnitude
from stiction.recording.origin import OriginOfStroke
from stiction.text.quantity.wording import in_words, to_error
from stiction.text.suggestion import Suggestion

ZERO = Suggestion("zero", of="")
ABOUT_ZERO = 0.05  # of half the drop: so far from zero the middle of a swing may lie
BOTH_SIGNS = 0.3  # of the largest force: so far it goes the other way where a drive turns


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


def zero_shown(record: Record, friction: Friction, cycles: CycleTable) -> InitialRest | None:
    """Return the rest with which a record begins, if its reading may be the zero.

    It may not where a zero is stated, or where the force returns so low while the mass slips: then
    the drive paused, and the spring was loaded.
    """
    known = friction.break_away or friction.kinetic
    if known is None or known.force <= 0.0 or is_stated(record):
        return None
    rest = initial_rest(record.force, known.force)
    if rest is None or rest.reading > BEGINS_UNLOADED * known.force:
        return None
    lowest = float(cycles["trough"].min()) if len(cycles) else known.force
    return rest if rest.reading < lowest else None


def place_of_stroke(record: Record) -> OriginOfStroke | None:
    """Return where a record stands among the strokes of its file, if it is one of them."""
    return None if record.origin is None else record.origin.stroke


def zero_of_strokes(record: Record) -> InitialRest | None:
    """Return the middle of the forces forth and back, in the direction of a stroke, if it is off.

    It is the zero where friction is as large both ways.
    """
    stroke = place_of_stroke(record)
    if stroke is None or stroke.middle is None or is_stated(record):
        return None
    error = stroke.middle_error or 0.0
    least = max(ERRORS_997 * error, AT_REST * largest_magnitude(record.force))
    if abs(stroke.middle) <= least:
        return None
    return InitialRest(stroke.way * stroke.middle, error)


def reading_of_start(
    record: Record, friction: Friction, shown: InitialRest | None
) -> InitialRest | None:
    """Return the first reading of a force that rises from the first sample on, if it is off.

    It is the zero if the spring was unloaded, and nothing if it was loaded already. Where the
    record begins in the middle of a loading, or after a turn of the drive, it is neither.
    """
    stroke = place_of_stroke(record)
    if is_stated(record) or shown is not None or friction.break_away is None:
        return None
    if stroke is not None and stroke.after_turn:
        return None
    reading, noise = first_level(record.force)
    least = max(AT_REST * largest_magnitude(record.force), NOISE * noise)
    return InitialRest(reading, noise) if abs(reading) > least else None


def may_be_zero(start: InitialRest | None, friction: Friction) -> bool:
    """Return whether a first reading is so small beside friction that it may be the zero."""
    top = friction.break_away
    if start is None or top is None:
        return False
    return abs(start.reading) <= BEGINS_UNLOADED * top.force


def is_hidden(record: Record, friction: Friction, shown: InitialRest | None) -> bool:
    """Return whether a record begins with a loaded spring, and nothing else tells its zero."""
    known = friction.static or friction.kinetic or friction.break_away
    if known is None or is_stated(record) or shown is not None:
        return False
    if place_of_stroke(record) is not None:
        return False
    return abs(first_level(record.force)[0]) > BEGINS_UNLOADED * abs(known.force)


def shift_of_zero(
    record: Record, friction: Friction, cycles: CycleTable, shown: InitialRest | None
) -> float:
    """Return by how much a zero that is off shifts friction, N; all of it if that is unreal.

    `shown` is what `zero_shown` returns, here and below.
    """
    if why_no_friction(record, friction, cycles):
        return inf
    shown = shown or _apparent_zero(record, friction)
    return 0.0 if shown is None else abs(shown.reading)


def _apparent_zero(record: Record, friction: Friction) -> InitialRest | None:
    """Return the zero that strokes, or a loading from the first sample on, seem to show."""
    middle = zero_of_strokes(record)
    if middle is not None:
        return middle
    start = reading_of_start(record, friction, None)
    return start if may_be_zero(start, friction) else None


def with_zero(friction: Friction, record: Record, shown: InitialRest | None) -> Friction:
    """Return the friction with the errors that follow if the record's apparent zero is true.

    A correction is made for an effect that is known (GUM, 3.2.4: JCGM 100:2008). This one is not: a
    spring that friction holds reads as much. So the values are those of the zero as it is supposed,
    and the error reaches to those of the other zero. A stated zero has its stated uncertainty.
    """
    shown = shown or _apparent_zero(record, friction)
    further = stated_error(record) if shown is None else hypot(shown.reading, shown.error)
    return friction.with_errors(break_away=further, static=further, kinetic=further)


def doubt_zero(
    record: Record, friction: Friction, cycles: CycleTable, shown: InitialRest | None
) -> Iterator[str]:
    """Doubt the zero if a record begins unloaded, or reaches impossible values.

    A stroke that begins at a turn of the drive cannot show the unloaded spring; the strokes forth
    and back together show the zero.
    """
    largest = largest_magnitude(record.force)
    if friction.kinetic is not None and is_about_zero(friction, cycles):
        yield (
            f"The mean friction is about zero, {in_words(friction.kinetic.force, 'N')}: the zero "
            "of the force is off, as behind an amplifier that lets no constant force through, or "
            f"the drive goes back and forth; give {ZERO}, the reading without load."
        )
        return
    if friction.kinetic is not None and friction.kinetic.force < 0.0:
        low, high = float(record.force.min()), float(record.force.max())
        if high > BOTH_SIGNS * largest:
            yield (
                f"The force lies between {in_words(low, 'N')} and {in_words(high, 'N')}: the drive "
                "goes back and forth, and a mean is not friction; or the zero of the force is off."
            )
            return
        yield (
            f"The mean friction is {in_words(friction.kinetic.force, 'N')}, against the drive: the "
            f"zero of the force is off, or its sign; give {ZERO}, the reading without load."
        )
        return
    if (trough := trough_against(record, friction, cycles)) is not None:
        yield (
            f"The troughs are against the drive, at {in_words(trough, 'N')}: the zero of the force "
            "is off, as behind an amplifier that lets no constant force through, or kinetic "
            f"friction is less than half of the static one; give {ZERO}, the reading without load."
        )
        return
    stroke = place_of_stroke(record)
    way = 1.0 if stroke is None else stroke.way
    middle = None if shown is not None else zero_of_strokes(record)
    if middle is not None:
        yield (
            f"{_less(friction, middle.reading)} if friction is as large on the way forth as on the "
            f"way back, whose middle is {in_words(way * middle.reading, 'N')}: if that is the zero "
            f"of the force, give {_zero_in_file(middle.reading, way)}. The errors of friction "
            "allow for it."
        )
        return
    if shown is not None:
        read = shown.reading
        if abs(read) <= max(AT_REST * largest, ERRORS_997 * shown.error):
            return
        turned = "; just after a turn of the drive it is not" if read < 0.0 else ""
        yield (
            f"{_less(friction, read)} if the start at {in_words(read, 'N')}, before the first "
            "loading, is the zero: if the spring was unloaded, give "
            f"{_zero_in_file(read, way)}{turned}. The errors of friction allow for it."
        )
        return
    start = reading_of_start(record, friction, shown)
    if start is not None:
        yield _doubt_start(start, friction)


def _doubt_start(start: InitialRest, friction: Friction) -> str:
    """Return the doubt about the zero of a force that rises from its first reading on."""
    read = start.reading
    after = ", as after a turn of the drive" if read < 0.0 else ""
    said = (
        "The record does not show the unloaded spring: from its first reading on, "
        f"{in_words(read, 'N')}, the force rises. "
    )
    if not may_be_zero(start, friction):
        return (
            f"{said}The spring was loaded already{after}, or the zero is off: give {ZERO}, the "
            "reading without load."
        )
    return (
        f"{said}{_less(friction, read)} if that is the zero, and as given if the spring was loaded "
        f"already{after}. The errors of friction allow for both: give {ZERO}, the reading without "
        "load."
    )


def _zero_in_file(reading: float, way: float) -> Suggestion:
    """Return how a zero is given, N: as the file has its forces, which a way back turns round."""
    return ZERO._replace(value=f"{way * reading:.4g} N")


def _less(friction: Friction, zero: float) -> str:
    """Return the friction with another zero, N, in words."""
    known = {"static": friction.static, "kinetic": friction.kinetic}
    if not any(known.values()):
        known = {"break-away": friction.break_away}
    shown = {name: _by(each, zero) for name, each in known.items() if each is not None}
    first, *others = (f"{name} {{}}{number}" for name, number in shown.items())
    return " and ".join(
        [first.format("friction is ").capitalize(), *(x.format("") for x in others)]
    )


def _by(its: Measured, zero: float) -> str:
    """Return a coefficient by another zero, N, or the force where the load is unknown."""
    force = its.force - zero
    if not isfinite(its.coefficient):
        return to_error(force, its.error, "N")
    return to_error(its.coefficient * force / its.force, its.coefficient_error, "1")
