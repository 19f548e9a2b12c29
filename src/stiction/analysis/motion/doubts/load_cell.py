"""Doubts about a load cell that rings after each slip."""

from __future__ import annotations

from collections.abc import Iterator

from stiction.analysis.motion.friction import Friction
from stiction.analysis.motion.load_cell.swings import CellSwings
from stiction.text.quantity.wording import in_words


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
