"""Doubts about means over cycles that differ, and about the parts of a record without any."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from stiction.analysis.motion.changes.cycles import (
    cycles_apart,
    parts_of,
    stand_apart,
    steady_change,
)
from stiction.analysis.motion.course import QUIET
from stiction.analysis.motion.friction import Friction
from stiction.analysis.record import Record
from stiction.arrays import xr
from stiction.text.units import in_words

QUIET_SHARE = 0.15  # of the record
NAMED = 3  # cycles apart; more are counted


def doubt_mean_period(cycles: xr.Dataset) -> Iterator[str]:
    """Doubt one mean over cycles of which parts have a period of their own."""
    period, start = cycles["period"].values, cycles["start"].values
    parts = parts_of(period)
    if len(parts) < 2:
        return
    lasts = [in_words(float(np.median(period[part])), "s") for part in parts]
    later = [
        f"from {in_words(float(start[part.start]), 's')} on{' the cycles take' * (k == 0)} {long}"
        for k, (part, long) in enumerate(zip(parts[1:], lasts[1:], strict=True))
    ]
    yield (
        f"{', '.join(later).capitalize()}, before {lasts[0]}: if the drive or the load changed "
        f"there, analyse the {'two ' * (len(parts) == 2)}parts by themselves; means over "
        f"{'both' if len(parts) == 2 else 'all'} mean little."
    )


def doubt_loading(cycles: xr.Dataset) -> Iterator[str]:
    """Name a rate of loading that goes on changing."""
    ends = steady_change(cycles["stick_slope"].values)
    if ends is None or len(parts_of(cycles["period"].values)) > 1:
        return
    first, last = (in_words(end, "N/s") for end in ends)
    yield (
        f"The rate of loading changes from {first} to {last}, from cycle to cycle: the drive does "
        "not keep one velocity, so that creep, slip and stiffness by it are not given."
    )


def doubt_cycles_apart(cycles: xr.Dataset) -> Iterator[str]:
    """Name cycles far longer or deeper than the others, which the means leave out."""
    if not cycles_apart(cycles).any():
        return
    period, drop = cycles["period"].values, cycles["drop"].values
    starts, peaks = cycles["start"].values, cycles["peak_time"].values
    deep = stand_apart(drop)
    for at in np.flatnonzero(deep)[:NAMED]:
        yield (
            f"At {in_words(float(peaks[at]), 's')} the force falls by "
            f"{in_words(float(drop[at]), 'N')}, {drop[at] / np.median(drop):.2g} times the median "
            f"of all falls, {in_words(float(np.median(drop)), 'N')}: a knock, or a slip of another "
            "kind. Means over the cycles leave it out."
        )
    long, middle = stand_apart(period), float(np.median(period))
    long[1:] &= ~deep[:-1]  # a loading after a deep fall is as long as that is deep
    found = [
        f"from {in_words(float(starts[at]), 's')} on takes {in_words(float(period[at]), 's')}, "
        f"{period[at] / middle:.2g} times the median, {in_words(middle, 's')}"
        for at in np.flatnonzero(long)[:NAMED]
    ]
    if found:
        more = np.count_nonzero(long) - len(found)
        others = f", and {more} more are as long" if more else ""
        yield (
            f"The cycle {'; that '.join(found)}{others}: if the drive paused, analyse the parts "
            "before and after by themselves. Means over the cycles leave "
            f"{'it' if len(found) == 1 else 'them'} out."
        )


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
