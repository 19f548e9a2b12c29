"""The effects of a load cell's ringing after each slip on the cycles of a record."""

from __future__ import annotations

from math import pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.loading import (
    are_flanks,
    late_line,
    loading_rate,
    rise_ends,
    tops_of_rises,
)
from stiction.analysis.record import Record
from stiction.analysis.signals.digitised import fall_by_rounding
from stiction.arrays import Floats
from stiction.recording.noise import white_noise

GAP = 4.0  # sampling steps without a sample
OFTEN = 0.5  # of the rises: if more ring, the load cell does


class CellSwings(NamedTuple):
    """The effect of a load cell's ringing after each slip on troughs, peaks (N) and rates (N/s).

    By so much they are off in the usual rise.
    """

    trough: float
    peak: float
    rate: float

    @property
    def shift(self) -> float:
        """By how much they shift static or kinetic friction, N, at most."""
        return max(self.peak, 0.5 * self.trough)


def swings_of_cell(record: Record, cycles: CycleTable) -> CellSwings | None:
    """Return the effect of a load cell's ringing on the cycles of a record; None without any.

    The first swing after a slip makes the trough. Later it has faded: the line through the last
    part of a rise tells how deep the trough is without it, and what is left of it at the peak. In a
    radian before the peak a swing follows the force, which lags or overshoots by as much. A trough
    that were higher by a whole rise, or lower, is not one of a load cell.
    """
    time, force = record.time, record.force
    cycles = cycles.part(~_with_gap(time, cycles))
    if not len(cycles):
        return None
    start, peak_time = cycles["start"], cycles["peak_time"]
    first, last = rise_ends(time, start, peak_time)
    tops = time[tops_of_rises(time, force, first, last)[0]]
    of_noise = 2.0 * np.sqrt(2.0 * np.log(last - first + 1.0))  # the usual range of so many
    hidden = of_noise * white_noise(force) + fall_by_rounding(force)
    rings = are_flanks(time, force, start, tops, peak_time, hidden)
    if not np.mean(rings) > OFTEN:
        return None
    late = late_line(time, force, first, last, 0.5 * (tops + peak_time))
    slope = late.coefficients[:, 1] / late.half
    lift = late.coefficients[:, 0] + slope * (start - late.middle) - cycles["start_force"]
    over = np.maximum(force[last] - late.coefficients.sum(axis=1), slope * (tops - start) / pi)
    away = np.abs(loading_rate(time, force, start, peak_time) - slope)
    found = CellSwings(*(float(np.median(each[rings])) for each in (lift, over, away)))
    rises = force[last] - cycles["start_force"]
    return found if 0.0 < found.trough < float(np.median(rises[rings])) else None


def _with_gap(time: Floats, cycles: CycleTable) -> NDArray[np.bool_]:
    """Return which rises have samples missing: a straight line over a gap is not a rise."""
    steps = np.diff(time)
    missing = np.append(0, np.cumsum(steps > GAP * np.median(steps)))
    first, last = rise_ends(time, cycles["start"], cycles["peak_time"])
    return np.asarray(missing[last] > missing[first])
