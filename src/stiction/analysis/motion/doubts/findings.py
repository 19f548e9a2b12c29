"""All that is known of a record before its numbers are doubted."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from stiction.analysis.motion.changes.cycles import cycles_apart
from stiction.analysis.motion.changes.mean_load import FollowedLoad
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.drift import Drift, is_shown
from stiction.analysis.motion.friction import Friction
from stiction.analysis.motion.load_cell.swings import CellSwings
from stiction.analysis.motion.metadata.quantity import StatedQuantity
from stiction.analysis.motion.regime.evidence import Regime
from stiction.analysis.motion.regime.kinds import STICK_SLIP, TRANSITIONAL
from stiction.analysis.motion.zero import ZeroShown
from stiction.analysis.record import Record
from stiction.analysis.signals.clipping import FlatEnd


class Findings(NamedTuple):
    """The findings in a record by which its numbers are doubted."""

    record: Record  # with the force to which its load cell answered, if that rings
    regime: Regime
    turns: str  # the imposed reversal that leaves no mean as kinetic friction, in words, or empty
    cycles: CycleTable
    friction: Friction  # of the force, without the errors that doubts give it
    drift: Drift  # sure or not
    ends: Sequence[FlatEnd]  # values at which the force is cut off
    load: FollowedLoad | None = None  # the load that the force follows
    # quantities that are stated of the apparatus, beside those that the force shows
    stated: tuple[StatedQuantity, ...] = ()
    rings: CellSwings | None = None  # of the load cell after each slip
    zero: ZeroShown | None = None  # the zero that the record shows

    @property
    def slips(self) -> bool:
        """Whether the mass sticks and slips, shortly at least."""
        return self.regime.kind in (STICK_SLIP, TRANSITIONAL)

    @property
    def usual(self) -> CycleTable:
        """The cycles without those that stand apart."""
        return self.cycles.part(~cycles_apart(self.cycles))

    @property
    def alike(self) -> CycleTable:
        """The cycles that repeat one motion: none where drive or force turns round."""
        return self.cycles.part(slice(0)) if self.turns else self.cycles

    @property
    def shown_drift(self) -> Drift | None:
        """The drift, if a motion of this kind shows a steady one, or none."""
        return self.drift if is_shown(self.drift, self.regime.kind) else None
