"""A ringing that dies out within a record, as after a knock, beside cycles that go on."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.analysis.motion.course import ORDERED, order
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.arrays import Floats

SHORT = 0.25  # of the record: a ringing that lasts no longer is not a motion of its own
BEFORE = 0.75  # of a period before its first peak
LEFT, SLOWEST = 0.05, 0.95  # of its last swing at its end; a swing over the last one at most
FEWEST_SWINGS = 3  # two are one smaller than the other by chance, half of the time
ELSEWHERE = 3.0  # times the period: peaks farther apart are not of one ringing


class Ringing(NamedTuple):
    """When a ringing begins and ends (s), and its largest fall (N)."""

    begin: float
    end: float
    height: float


def ringing_of(time: Floats, peak: Floats, drop: Floats) -> Ringing | None:
    """Return where swings that die out ring, if that is a short part within a record.

    Of each swing count the time of its peak, s, and its height `drop`, N; `time` is the record's.
    """
    gaps = np.diff(peak)
    if not len(gaps):
        return None
    period = float(np.median(gaps))
    near = gaps < period / ELSEWHERE
    if near.any():  # it has fewer swings than there are cycles
        period, largest = float(np.median(gaps[near])), int(np.argmax(near))
    else:
        near, largest = gaps <= ELSEWHERE * period, int(np.argmax(drop))
    apart = np.flatnonzero(~near)
    first = int(apart[apart < largest][-1]) + 1 if (apart < largest).any() else 0
    last = int(apart[apart >= largest][0]) if (apart >= largest).any() else len(peak) - 1
    size = drop[first : last + 1]
    if len(size) < FEWEST_SWINGS or order(size) > ORDERED:
        return None
    factor = min(float(size[-1] / size[0]) ** (1.0 / (len(size) - 1)), SLOWEST)
    begin = float(peak[first]) - BEFORE * period
    end = float(peak[last]) + (1.0 + np.log(LEFT) / np.log(factor)) * period
    within = time[0] < begin and end < time[-1]
    if not within or end - begin > SHORT * (time[-1] - time[0]):
        return None
    return Ringing(begin, end, float(size.max()))


def beside(table: CycleTable, ringing: Ringing) -> CycleTable:
    """Return the cycles of a table that a ringing does not touch."""
    return table.part((table["trough_time"] < ringing.begin) | (table["start"] > ringing.end))


def without_ringing(time: Floats, force: Floats, ringing: Ringing) -> Floats:
    """Return a force with a straight line in place of a ringing."""
    inside = (time > ringing.begin) & (time < ringing.end)
    smooth = force.copy()
    smooth[inside] = np.interp(time[inside], time[~inside], force[~inside])
    return smooth
