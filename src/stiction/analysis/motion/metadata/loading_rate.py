"""The rate of loading while the mass sticks, beside stiffness times drive velocity."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, inf, isfinite, nan

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.motion.changes.cycles import parts_of, steady_change
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.drift import Drift
from stiction.analysis.motion.load_cell.swings import swings_of_cell
from stiction.analysis.motion.loading import late_rate, rounding_of_rates
from stiction.analysis.motion.metadata.quantity import ALIKE_VALUES, StatedQuantity, median_error
from stiction.analysis.motion.regime.force_course import FASTEST
from stiction.analysis.motion.regime.kinds import STICK_SLIP, TRANSITIONAL
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import ERRORS_95
from stiction.analysis.signals.straight_line import line
from stiction.arrays import Floats
from stiction.text.quantity.wording import in_words

LOADING_RATE, BY_RISE = "stiffness times drive velocity", "rate at which the force rises"
SLOWER = 0.5  # rate of loading over stiffness times drive velocity, where the mass creeps


def loading_rates(
    record: Record, kind: str, cycles: CycleTable, drift: Drift | None
) -> list[StatedQuantity]:
    """Compare the rate of loading while the mass sticks with stiffness times drive velocity.

    Where the cycles change, as after a step of the velocity, each part has its own rate. If one of
    them is as stated, nothing is stated of the others. Nor is anything where the rate goes on
    changing and passes the stated one, or a part of it that creep may leave.
    """
    if kind not in (STICK_SLIP, TRANSITIONAL):
        return []
    slopes, starts = cycles["stick_slope"], cycles["start"]
    stated = record.loading_rate or nan
    # a drift of the load cell seems to load the spring; one of friction does not
    off = abs(rate_of_drift(cycles, drift))
    if (rings := swings_of_cell(record, cycles)) is not None:
        off = hypot(off, rings.rate)
    alike = rounding_of_rates(
        record.force, float(np.median(cycles["peak"] - cycles["start_force"]))
    )
    late = late_rate(record.time, record.force, starts, cycles["peak_time"])
    whole = _loading_rate(slopes, late, stated, off, alike)
    places = parts_of(cycles["period"])
    if len(places) < 2:
        if steady_change(slopes) is None:
            return [whole]
        low, high = np.sort(line(starts, slopes).at(record.time[[0, -1]]))
        passes = SLOWER * stated < high and low < FASTEST * stated
        return [whole._replace(stated=nan) if passes else whole]
    at = [-inf, *(float(starts[place.start]) for place in places[1:]), inf]
    parts = []
    for place, begin, end in zip(places, at[:-1], at[1:], strict=True):
        its = _loading_rate(slopes[place], late[place], stated, off, alike)
        parts.append(its._replace(part=_part_in_words(begin, end), begin=begin, end=end))
    agree = [each for each in parts if each.is_same] or [x for x in parts if x.agrees]
    if not agree:
        return parts
    return [each if each in agree else each._replace(stated=nan) for each in parts]


def _part_in_words(begin: float, end: float) -> str:
    """Return a part of a record in words."""
    if begin == -inf:
        return f"until {in_words(end, 's')}"
    if end == inf:
        return f"from {in_words(begin, 's')} on"
    return f"from {in_words(begin, 's')} to {in_words(end, 's')}"


def rate_of_drift(cycles: CycleTable, drift: Drift | None) -> float:
    """Return the rate of a drift, N/s; without one, that at which the troughs change.

    A few cycles are too few to tell a drift.
    """
    if drift is not None:
        return drift.rate
    at, force = (
        np.append(cycles[first], cycles[last][-1:])
        for first, last in (("start", "trough_time"), ("start_force", "trough"))
    )
    return line(at, force).slope


def _loading_rate(
    slopes: Floats, late: Floats, stated: float, off: float, alike: float
) -> StatedQuantity:
    """Return the median rate of loading of some cycles.

    Its errors are that of the scatter, one of `off` (N/s), and a relative one that all have
    `alike`. It contradicts the stated one where it does so by more than two of them. Behind a
    steep filter a rise swings at first: one whose `late` rates are as stated may do so.
    """
    found, later = float(np.median(slopes)), float(np.median(late))
    off = hypot(off, alike * found)
    if found > FASTEST * stated and abs(later - stated) < ALIKE_VALUES * stated:
        off = hypot(off, found - later)
    error = hypot(median_error(slopes), off)
    # a single cycle tells no error, but by how much drift and steps may change it
    within = ERRORS_95 * (error if isfinite(error) else off) / stated
    low, high = SLOWER - within, FASTEST + within
    its = StatedQuantity(LOADING_RATE, "N/s", found, error, stated, low, high, BY_RISE)
    return its._replace(is_bound=True)


def other_velocity(stated: Sequence[StatedQuantity], cycles: CycleTable) -> NDArray[np.bool_]:
    """Return which cycles are loaded at another rate than the stated one.

    None are, if no cycles are loaded at the stated rate. All are, if the rate goes on changing.
    """
    rates, start = [each for each in stated if each.quantity == LOADING_RATE], cycles["start"]
    found = np.zeros(len(start), bool)
    if len(rates) == 1:
        changes = steady_change(cycles["stick_slope"]) is not None
        return found | (changes and rates[0].agrees is None)
    if any(each.agrees for each in rates):
        for each in rates:
            if not each.agrees:
                found |= (start >= each.begin) & (start < each.end)
    return found
