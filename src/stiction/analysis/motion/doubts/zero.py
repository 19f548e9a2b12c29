"""Doubts about the zero of a force: what a record shows of it, and what it does not."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.friction import Friction
from stiction.analysis.motion.metadata.comparison import AT_REST, first_reading
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import ERRORS_997
from stiction.analysis.signals.robust import largest_magnitude
from stiction.recording.noise import white_noise
from stiction.text.suggestion import Suggestion
from stiction.text.units import in_words

ZERO = Suggestion("zero", of="")
ABOUT_ZERO = 0.05  # of half the drop: so far from zero the middle of a swing may lie
BOTH_SIGNS = 0.3  # of the largest force: so far it goes the other way where a drive turns
NOISE = 5.0  # standard deviations: noise alone is as far from zero once in a million readings
SAME = 1e-9  # of the largest force: readings that differ by less are equal but for rounding
# Parts of the time up to half of the first loading, two of which are compared
PARTS = (8, 16, 32, 64)
FEWEST = 4  # samples in each of them
CONSTANT = 0.5  # of the average rate of that loading: a spring that is loaded already has all of it


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


def doubt_zero(record: Record, friction: Friction, cycles: CycleTable) -> Iterator[str]:
    """Doubt the zero if a record begins unloaded, or reaches impossible values."""
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
    if friction.break_away is None or record.zero is not None:
        return
    some = first_reading(record)
    noise = float(np.std(np.diff(some))) / 2.0**0.5
    within = max(NOISE * noise, SAME * largest)  # of the middle, to either side
    level = float(np.ptp(some)) < 2.0 * within
    read = float(np.median(some)) if level else float(some[0])
    if abs(read) <= max(AT_REST * largest, NOISE * noise):
        return
    turned = "; just after a turn of the drive it is not" if read < 0.0 else ""
    if _begins_at_rest(record, read, friction.break_away.force):
        yield (
            f"The record begins before the first loading, at {in_words(read, 'N')}: if the spring "
            f"was unloaded, give {ZERO._replace(value=f'{read:.4g} N')}{turned}."
        )
        return
    after = ", as after a turn of the drive" if read < 0.0 else ""
    yield (
        f"The record does not show the unloaded spring: from its first reading on, "
        f"{in_words(read, 'N')}, the force rises. The spring was loaded already{after}, or the "
        f"zero is off: give {ZERO}, the reading without load."
    )


def _begins_at_rest(record: Record, read: float, peak: float) -> bool:
    """Return whether the force is constant at first, and loaded only then up to a peak (N).

    A drive that starts after the recording leaves the spring as it was. In a force that rises from
    the first sample on, neighbouring parts differ by as much as half of its loading has it.
    """
    force, rise = record.force, peak - read
    half = int(np.argmax(force >= read + 0.5 * rise))
    noise = white_noise(force)
    for parts in PARTS:
        size = half // parts
        if size < FEWEST:
            break
        before, after = float(force[:size].mean()), float(force[size : 2 * size].mean())
        error = ERRORS_997 * noise * (2.0 / size) ** 0.5
        if abs(after - before) + error < CONSTANT * 0.5 * rise / parts:
            return True
    return False
