"""Hum and ringing in a force: those that were subtracted from it, and doubts about others."""

from __future__ import annotations

from collections.abc import Iterator

from stiction.analysis.motion.changes.ringing import Ringing
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.friction import Friction
from stiction.analysis.motion.load_cell.free_swings import RingingCell
from stiction.analysis.motion.load_cell.swings import CellSwings
from stiction.analysis.motion.regime.kinds import HARMONIC
from stiction.analysis.signals.hum import Line, of_mains
from stiction.text.quantity.wording import in_words


def subtracted_lines(
    lines: tuple[Line, ...], ringing: Ringing | None, cell: RingingCell | None = None
) -> tuple[str, ...]:
    """Return a sentence for each line, ringing, and load cell taken out of the force."""
    found = []
    if cell is not None:
        found.append(
            f"After each slip the force swings at {in_words(cell.frequency, 'Hz')} and fades, with "
            f"a quality factor of {cell.quality:.2g}, as where the load cell rings: cycles, "
            "friction and creep are those of the force to which such a cell answers."
        )
    if ringing is not None:
        lasts = in_words(ringing.end - ringing.begin, "s")
        found.append(
            f"From {in_words(ringing.begin, 's')} on, for {lasts}, the force rings by up to "
            f"{in_words(ringing.height, 'N')}, less and less, as after a knock, or where cycles "
            "end: there a straight line replaced it before the search for cycles."
        )
    for line in lines:
        hum = ", probably mains hum," if of_mains(line.frequency) else ""
        found.append(
            f"A line at {in_words(line.frequency, 'Hz')} with an amplitude of "
            f"{in_words(0.5 * line.height, 'N')}{hum} was subtracted from the force: cycles "
            "are sought in the rest."
        )
    return tuple(found)


def doubt_mains(kind: str, cycles: CycleTable) -> Iterator[str]:
    """Doubt a vibration at the mains frequency: nothing distinguishes it from hum."""
    if kind != HARMONIC or not len(cycles):  # the spectrum alone may show a vibration
        return
    lasts = float(cycles["trough_time"][-1] - cycles["start"][0])
    frequency = len(cycles) / lasts
    if of_mains(frequency):
        yield (
            f"The force swings at {in_words(frequency, 'Hz')}, as the mains do. Record it with the "
            "drive at rest: if it swings then, that is hum, and the mass slides steadily."
        )


def doubt_ringing(its: CellSwings | None) -> Iterator[str]:
    """Doubt troughs and drops where the load cell swings after each slip."""
    if its is not None:
        yield (
            "After each slip the force swings, as where the load cell rings: troughs are about "
            f"{in_words(its.trough, 'N', 2)} too low, and drops as much too large. The errors of "
            "friction and of the rate of loading allow for it."
        )


def with_ringing(friction: Friction, its: CellSwings | None) -> Friction:
    """Return the friction with the errors of peaks and troughs where the load cell rings."""
    if its is None:
        return friction
    return friction.with_errors(static=its.peak, kinetic=0.5 * max(its.trough, its.peak))
