"""Doubts about a force that is cut off at the ends of the load cell's range."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import inf

import numpy as np

from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.friction import Friction, Measured
from stiction.analysis.record import Record
from stiction.analysis.signals.clipping import FlatEnd
from stiction.analysis.signals.correlated_noise import ERRORS_997
from stiction.text.units import in_words

FEW = 0.05  # of the cycles: if fewer are cut off, means over all of them hardly change
ENDS = {"largest": "peaks", "least": "troughs"}
SHOWN = {
    "largest": "static and kinetic coefficients and drops are too small, and what seems to creep "
    "there may rest",
    "least": "drops are too small and kinetic coefficients too large",
}


def doubt_clipping(ends: Sequence[FlatEnd]) -> Iterator[str]:
    """Doubt a force that stays at exactly its largest or least value for longer than elsewhere."""
    for name, value, longest in ends:
        yield (
            f"The force stays at exactly {in_words(value, 'N')} for up to {longest} samples, its "
            f"{name} value: if that is the end of the load cell's range, {ENDS[name]} are cut off, "
            f"{SHOWN[name]}."
        )


def without_cut_off(
    friction: Friction, record: Record, cycles: CycleTable, ends: Sequence[FlatEnd]
) -> Friction:
    """Return the friction without what peaks and troughs do not show that are cut off at ends."""
    end = next((each.value for each in ends if each.name == "largest"), None)
    broke = friction.break_away
    if end is not None and broke is not None and _breaks_at(record, cycles, broke, end):
        reason = f"the peak is cut off: it is {in_words(broke.force, 'N')} or more"
        friction = friction._replace(
            break_away=None, missing=friction.missing | {"break_away": reason}
        )
    reached = _ends_reached(record, cycles, ends)
    if "largest" in reached and friction.static is not None:
        least = in_words(friction.static.force, "N")
        friction = friction.without_static(f"{_in_words(reached)}: it is {least} or more")
    if reached and friction.kinetic is not None:
        bounds = {"largest": "more", "least": "less"}
        bound = f": it is {in_words(friction.kinetic.force, 'N')} or {bounds[reached[0]]}"
        friction = friction.without_kinetic(_in_words(reached) + bound * (len(reached) == 1))
    return friction


def cut_off(record: Record, cycles: CycleTable, ends: Sequence[FlatEnd]) -> str:
    """Return what of the cycles is cut off at ends, in words; '' if nothing is."""
    return _in_words(_ends_reached(record, cycles, ends))


def _in_words(reached: Sequence[str]) -> str:
    return f"the {' and '.join(ENDS[name] for name in reached)} are cut off" if reached else ""


def _ends_reached(record: Record, cycles: CycleTable, ends: Sequence[FlatEnd]) -> list[str]:
    """Return the names of the ends that the cycles reach."""
    return [each.name for each in ends if _is_reached(record, cycles, each.value)]


def _breaks_at(record: Record, cycles: CycleTable, broke: Measured, end: float) -> bool:
    """Return whether the first break-away may be a value, which the force had until its trough."""
    until = cycles["start"][0] if len(cycles) else inf
    near = broke.force + ERRORS_997 * broke.error >= end
    return near and bool((record.force[record.time <= until] == end).any())


def _is_reached(record: Record, cycles: CycleTable, value: float) -> bool:
    """Return whether the force has a value in more than a few of its cycles."""
    there = record.time[record.force == value]
    begin, end = (np.searchsorted(there, cycles[name]) for name in ("start", "trough_time"))
    return bool(np.count_nonzero(end > begin) > FEW * len(cycles))
