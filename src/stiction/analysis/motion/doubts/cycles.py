"""Doubts about means over cycles that differ, and about the parts of a record without any."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from stiction.analysis.motion.course import QUIET, change_of_period
from stiction.analysis.motion.friction import Friction
from stiction.analysis.record import Record
from stiction.arrays import Floats, xr
from stiction.text.units import in_words

FAR_ABOVE = 5.0  # times the median of the falls
QUIET_SHARE = 0.15  # of the record
# A cycle in which the drive may have paused: over the median period, and over the span of periods,
# a tenth left out at each end; of measured stick-slip without a pause it comes to 1.4 spans
PAUSED, BEYOND, FEWEST_CYCLES, MANY_CYCLES = 3.0, 5.0, 5, 10


def doubt_mean_period(cycles: xr.Dataset) -> Iterator[str]:
    """Doubt one mean over cycles of which the later have another period than the earlier."""
    period = cycles["period"].values
    k = change_of_period(period)
    if k is None:
        return
    at = in_words(float(cycles["start"].values[k]), "s")
    first, second = (in_words(float(np.median(part)), "s") for part in (period[:k], period[k:]))
    yield (
        f"From {at} on the cycles take {second}, before {first}: if the drive or the load changed "
        "there, analyse the two parts by themselves; means over both mean little."
    )


def doubt_longest_cycle(cycles: xr.Dataset) -> Iterator[str]:
    """Doubt means over cycles of which one takes far longer than the others, as in a pause."""
    period = cycles["period"].values
    if not _stands_out(period, PAUSED):
        return
    longest, middle = float(period.max()), float(np.median(period))
    at = in_words(float(cycles["start"].values[period.argmax()]), "s")
    yield (
        f"The cycle from {at} on takes {in_words(longest, 's')}, {longest / middle:.2g} times the "
        f"median, {in_words(float(middle), 's')}: if the drive paused, analyse the parts before "
        "and after by themselves; means over all cycles, such as of period and creep, mean little."
    )


def doubt_highest_fall(cycles: xr.Dataset) -> Iterator[str]:
    """Doubt means over cycles of which one falls far deeper than the others, as after a knock."""
    drop = cycles["drop"].values
    if not _stands_out(drop, FAR_ABOVE):
        return
    highest, middle = float(drop.max()), float(np.median(drop))
    at = in_words(float(cycles["peak_time"].values[drop.argmax()]), "s")
    yield (
        f"At {at} the force falls by {in_words(highest, 'N')}, {highest / middle:.2g} times the "
        f"median of all falls, {in_words(float(middle), 'N')}: a knock, or a slip of another kind. "
        "It is one of the cycles, and means over them contain it."
    )


def _stands_out(values: Floats, times: float) -> bool:
    """Return whether the largest value is many times the median, and far beyond all others.

    Of few values these others span all that is known.
    """
    if len(values) < FEWEST_CYCLES:
        return False
    low, high = np.percentile(values, (10.0, 90.0))
    if len(values) < MANY_CYCLES:
        others = np.sort(values)[:-1]
        low, high = others[0], others[-1]
    largest, middle = float(values.max()), float(np.median(values))
    return largest >= times * middle and largest - middle >= BEYOND * (high - low)


def doubt_quiet(record: Record, friction: Friction, cycles: xr.Dataset) -> Iterator[str]:
    """Name long parts of a record without cycles, before the first or after the last of them."""
    if not cycles.sizes["cycle"]:
        return
    least = max(QUIET * float(cycles["period"].max()), QUIET_SHARE * record.duration)
    first, last = float(cycles["start"][0]), float(cycles["trough_time"][-1])
    parts = {}
    if first - record.time[0] > least and friction.break_away is None:
        parts[f"Before {in_words(first, 's')}"] = record.time <= first
    if record.time[-1] - last > least:
        parts[f"After {in_words(last, 's')}"] = record.time >= last
    for when, inside in parts.items():
        lasts = in_words(float(np.ptp(record.time[inside])), "s")
        yield (
            f"{when} the force has no such cycles, for {lasts}: the report is of the cycles. "
            "Analyse that part by itself."
        )
