"""Doubts about the zero of a force, in words."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from stiction.analysis.motion.doubts.findings import Findings
from stiction.analysis.motion.friction import Friction, Measured
from stiction.analysis.motion.metadata.comparison import AT_REST
from stiction.analysis.motion.zero import (
    is_about_zero,
    place_of_stroke,
    reading_of_start,
    trough_against,
)
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import ERRORS_997
from stiction.analysis.signals.robust import largest_magnitude
from stiction.text.quantity.wording import in_words, to_error
from stiction.text.suggestion import Suggestion

ZERO = Suggestion("zero", of="")
BOTH_SIGNS = 0.3  # of the largest force: so far it goes the other way where a drive turns


def doubt_zero(its: Findings) -> Iterator[str]:
    """Doubt the zero if a record reaches impossible values, or begins unloaded; the first counts.

    A stroke that begins at a turn of the drive cannot show the unloaded spring; the strokes forth
    and back together show the zero.
    """
    doubts = (_about_zero, _against_drive, _troughs_against, _by_strokes, _by_rest, _by_start)
    said = next(filter(None, (doubt(its) for doubt in doubts)), "")
    if said:
        yield said


def _about_zero(its: Findings) -> str:
    mean = its.friction.kinetic
    if mean is None or not is_about_zero(its.friction, its.alike):
        return ""
    return (
        f"The mean friction is about zero, {in_words(mean.force, 'N')}: the zero "
        "of the force is off, as behind an amplifier that lets no constant force through, or "
        f"the drive goes back and forth; give {ZERO}, the reading without load."
    )


def _against_drive(its: Findings) -> str:
    mean, force = its.friction.kinetic, its.record.force
    if mean is None or mean.force >= 0.0:
        return ""
    low, high = float(force.min()), float(force.max())
    if high > BOTH_SIGNS * largest_magnitude(force):
        return (
            f"The force lies between {in_words(low, 'N')} and {in_words(high, 'N')}: the drive "
            "goes back and forth, and a mean is not friction; or the zero of the force is off."
        )
    return (
        f"The mean friction is {in_words(mean.force, 'N')}, against the drive: the "
        f"zero of the force is off, or its sign; give {ZERO}, the reading without load."
    )


def _troughs_against(its: Findings) -> str:
    trough = trough_against(its.record, its.friction, its.alike)
    if trough is None:
        return ""
    return (
        f"The troughs are against the drive, at {in_words(trough, 'N')}: the zero of the force "
        "is off, as behind an amplifier that lets no constant force through, or kinetic "
        f"friction is less than half of the static one; give {ZERO}, the reading without load."
    )


def _by_strokes(its: Findings) -> str:
    shown, stroke = its.zero, place_of_stroke(its.record)
    if shown is None or shown.by != "strokes" or stroke is None:
        return ""
    return (
        f"{_less(its.friction, shown.reading)} if friction is as large on the way forth as on the "
        f"way back, whose middle is {in_words(stroke.way * shown.reading, 'N')}: if that is the "
        f"zero of the force, give {_zero_in_file(shown.reading, its.record)}. The errors of "
        "friction allow for it."
    )


def _by_rest(its: Findings) -> str:
    shown = its.zero
    if shown is None or shown.by != "rest":
        return ""
    least = max(AT_REST * largest_magnitude(its.record.force), ERRORS_997 * shown.error)
    if abs(shown.reading) <= least:
        return ""
    turned = "; just after a turn of the drive it is not" if shown.reading < 0.0 else ""
    return (
        f"{_less(its.friction, shown.reading)} if the start at {in_words(shown.reading, 'N')}, "
        "before the first loading, is the zero: if the spring was unloaded, give "
        f"{_zero_in_file(shown.reading, its.record)}{turned}. The errors of friction allow for it."
    )


def _by_start(its: Findings) -> str:
    if its.zero is not None and its.zero.by != "start":
        return ""
    start = its.zero or reading_of_start(its.record, its.friction)
    if start is None:
        return ""
    read = start.reading
    after = ", as after a turn of the drive" if read < 0.0 else ""
    said = (
        "The record does not show the unloaded spring: from its first reading on, "
        f"{in_words(read, 'N')}, the force rises. "
    )
    if its.zero is None:
        return (
            f"{said}The spring was loaded already{after}, or the zero is off: give {ZERO}, the "
            "reading without load."
        )
    return (
        f"{said}{_less(its.friction, read)} if that is the zero, and as given if the spring was "
        f"loaded already{after}. The errors of friction allow for both: give {ZERO}, the reading "
        "without load."
    )


def _zero_in_file(reading: float, record: Record) -> Suggestion:
    """Return how a zero is given, N: as the file has its forces, which a way back turns round."""
    stroke = place_of_stroke(record)
    way = 1.0 if stroke is None else stroke.way
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
