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
from stiction.analysis.signals.digitised import resolution
from stiction.recording.noise import white_noise
from stiction.text.quantity.wording import in_words

FEW_CYCLES = 0.05  # of the cycles: if fewer are cut off, means over all of them hardly change
# Of samples at the end of a range in noise: so many, so many times as dense as those below, in so
# many of the cycles, and so many in each of these; and widths that are tried, over the noise, up to
# a part of the drop. At the top of a sine samples are 2.7 times as dense as below, and five times
# where a mass creeps at four fifths of the velocity
MANY, DENSE, OFTEN, EACH = 20, 8.0, 0.25, 2
WIDTHS, WIDE = np.geomspace(1e-3, 8.0, 14), 0.1
# Of the means of cycles at that end: how many tell whether they are one level, and their variance
# over that which noise gives them: with such an end it is more in one of 164 records, and without,
# where friction differs by a third of the noise, less in two of 12
FEWEST_LEVELS, UNLIKE = 3, 4.0
ENDS = {"largest": "peaks", "least": "troughs"}
EFFECTS = {
    "largest": "static and kinetic coefficients and drops are too small, and what seems to creep "
    "there may rest",
    "least": "drops are too small and kinetic coefficients too large",
}


def noisy_end(record: Record, cycles: CycleTable) -> list[FlatEnd]:
    """Return the end of the range at which peaks are cut off in noise, if they are.

    An amplifier whose range ends before that of the converter has noise there, too. Samples crowd
    at the largest force, in many of the cycles, as they do not below, and as noise has the fewest.
    """
    step, noise = resolution(record.force), white_noise(record.force)
    if not len(cycles) or noise == 0.0:
        return []
    below = record.force.max() - record.force
    widest = min(WIDTHS[-1] * noise, WIDE * cycles.median("drop"))
    near = np.sort(below[below < 3.0 * widest])
    widths = WIDTHS * noise
    for width in widths[(widths > 2.0 * step) & (widths <= widest)]:
        top, others = np.searchsorted(near, (width, 3.0 * width))
        if top < MANY or top < DENSE * 0.5 * (others - top):
            continue
        edges = np.flatnonzero(np.diff(below < width, prepend=False, append=False))
        longest = int(np.diff(edges)[::2].max())
        end = FlatEnd("largest", float(record.force.max() - near[top // 2]), longest, float(width))
        reached = _share_reached(record, cycles, end)
        often = reached > OFTEN and top > EACH * reached * len(cycles)
        return [end] if often and _is_one_level(record, cycles, end) else []
    return []


def _is_one_level(record: Record, cycles: CycleTable, end: FlatEnd) -> bool:
    """Return whether the force at an end is the same in all cycles, but for noise.

    So is the end of a range, and not the friction of a mass that slides before each slip. Their
    variance about the mean of each cycle, and that of these means, are compared.
    """
    at = np.flatnonzero(end.mask(record.force))
    begin, last = (
        np.searchsorted(record.time[at], cycles[name]) for name in ("start", "trough_time")
    )
    groups = [record.force[at[i:j]] for i, j in zip(begin, last, strict=True) if j - i > EACH]
    if len(groups) < FEWEST_LEVELS:
        return True
    values, count = np.concatenate(groups), np.array([len(each) for each in groups])
    means = np.array([each.mean() for each in groups])
    among = float((count * (means - values.mean()) ** 2).sum()) / (len(groups) - 1)
    inside = float(((values - np.repeat(means, count)) ** 2).sum()) / (len(values) - len(groups))
    return among <= UNLIKE * inside  # both are 0 where all samples are alike


def doubt_clipping(ends: Sequence[FlatEnd]) -> Iterator[str]:
    """Doubt a force that stays at exactly its largest or least value for longer than elsewhere."""
    for name, value, longest, within in ends:
        near = f"within {in_words(within, 'N', 2)} of" if within else "at exactly"
        yield (
            f"The force stays {near} {in_words(value, 'N')}, its {name} value, for up to {longest} "
            f"samples: if that is the end of the load cell's range, {ENDS[name]} are cut off, "
            f"{EFFECTS[name]}."
        )


def without_cut_off(
    friction: Friction, record: Record, cycles: CycleTable, ends: Sequence[FlatEnd]
) -> Friction:
    """Return the friction without the values that clipped peaks and troughs hide."""
    end = next((each for each in ends if each.name == "largest"), None)
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
    """Return the clipped parts of the cycles in words; '' if there are none."""
    return _in_words(_ends_reached(record, cycles, ends))


def _in_words(reached: Sequence[str]) -> str:
    return f"the {' and '.join(ENDS[name] for name in reached)} are cut off" if reached else ""


def _ends_reached(record: Record, cycles: CycleTable, ends: Sequence[FlatEnd]) -> list[str]:
    """Return the names of the ends that more than a few of the cycles reach."""
    return [each.name for each in ends if _share_reached(record, cycles, each) > FEW_CYCLES]


def _breaks_at(record: Record, cycles: CycleTable, broke: Measured, end: FlatEnd) -> bool:
    """Return whether the first break-away may be an end, where the force was until its trough."""
    until = cycles["start"][0] if len(cycles) else inf
    near = broke.force + ERRORS_997 * broke.error >= end.value - end.within
    return near and bool(end.mask(record.force[record.time <= until]).any())


def _share_reached(record: Record, cycles: CycleTable, end: FlatEnd) -> float:
    """Return in which share of its cycles the force is at an end."""
    there = record.time[end.mask(record.force)]
    begin, last = (np.searchsorted(there, cycles[name]) for name in ("start", "trough_time"))
    return float(np.count_nonzero(last > begin)) / max(len(cycles), 1)
