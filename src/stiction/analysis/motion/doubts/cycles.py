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
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.friction import Friction
from stiction.analysis.motion.regime.kinds import HARMONIC
from stiction.analysis.record import Record
from stiction.analysis.signals.robust import uniform_mean
from stiction.recording.noise import white_noise
from stiction.text.quantity.wording import in_words, percent, times

QUIET_SHARE = 0.15  # of the record
# By how much drops of a vibration differ from those of a sine of the same variance, and noise over
# drops, that are worth a word; cycles that show it
OFF, LOUD, MANY = 0.03, 0.03, 8
NAMED = 3  # cycles apart; more are counted


def doubt_mean_period(cycles: CycleTable) -> Iterator[str]:
    """Doubt one mean period for a record whose parts have different periods."""
    period, start = cycles["period"], cycles["start"]
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


def doubt_loading(cycles: CycleTable) -> Iterator[str]:
    """Name a rate of loading that goes on changing."""
    ends = steady_change(cycles["stick_slope"])
    if ends is None or len(parts_of(cycles["period"])) > 1:
        return
    first, last = (in_words(end, "N/s") for end in ends)
    yield (
        f"The rate of loading changes from {first} to {last}, from cycle to cycle: the drive does "
        "not keep one velocity, so that creep, slip and stiffness by it are not given."
    )


def doubt_cycles_apart(cycles: CycleTable, *, followed: bool = False) -> Iterator[str]:
    """Name cycles far longer or deeper than the others, which the means leave out.

    A drive whose displacement is `followed` shows by that whether it paused.
    """
    if not cycles_apart(cycles).any():
        return
    period, drop = cycles["period"], cycles["drop"]
    starts, peaks = cycles["start"], cycles["peak_time"]
    deep = stand_apart(drop)
    for at in np.flatnonzero(deep)[:NAMED]:
        yield (
            f"At {in_words(float(peaks[at]), 's')} the force falls by "
            f"{in_words(float(drop[at]), 'N')}, {times(drop[at] / np.median(drop))} the median "
            f"of all falls, {in_words(float(np.median(drop)), 'N')}: a knock, or a slip of another "
            "kind. Means over the cycles leave it out."
        )
    long, middle = stand_apart(period), float(np.median(period))
    long[1:] &= ~deep[:-1]  # a loading after a deep fall is as long as that is deep
    found = [
        f"from {in_words(float(starts[at]), 's')} on takes {in_words(float(period[at]), 's')}, "
        f"{times(period[at] / middle)} the median, {in_words(middle, 's')}"
        for at in np.flatnonzero(long)[:NAMED]
    ]
    if found:
        more = np.count_nonzero(long) - len(found)
        others = f", and {more} more are as long" if more else ""
        paused = ": if the drive paused, analyse the parts before and after by themselves"
        yield (
            f"The cycle {'; that '.join(found)}{others}{'' if followed else paused}. Means over "
            f"the cycles leave {'it' if len(found) == 1 else 'them'} out."
        )


def doubt_quiet(record: Record, friction: Friction, cycles: CycleTable) -> Iterator[str]:
    """Name long parts of a record without cycles, before the first or after the last of them."""
    if not len(cycles):
        return
    least = max(QUIET * float(cycles["period"].max()), QUIET_SHARE * record.duration)
    first, last = float(cycles["start"][0]), float(cycles["trough_time"][-1])
    parts = {}
    if first - record.time[0] > least and friction.break_away is None:
        parts["Before", first] = record.time <= first
    if record.time[-1] - last > least:
        parts["After", last] = record.time >= last
    for (when, at), inside in parts.items():
        bound, lasts = (in_words(each, "s") for each in (at, np.ptp(record.time[inside])))
        long = f", for {lasts}," * (lasts != bound)
        yield (
            f"{when} {bound}{long} the force has no cycles like those that this report describes. "
            "Analyse that part by itself."
        )


def doubt_drops_in_noise(record: Record, kind: str, cycles: CycleTable) -> Iterator[str]:
    """Doubt the drops of a vibration in noise: an extreme of noise is not its mean.

    Noise raises peaks, and the averages that it requires lower them. A sine has the variance of an
    eighth of its squared drop; white noise adds its own to that.
    """
    if kind != HARMONIC or len(cycles) < MANY:
        return
    noise, drop = white_noise(record.force), float(cycles["drop"].mean())
    first, last = np.searchsorted(
        record.time, [float(cycles["start"][0]), float(cycles["trough_time"][-1])]
    )
    force, length = record.force[first:last], round((last - first) / len(cycles))
    variance = float((force - uniform_mean(force, length)).var()) - noise**2
    sine = (8.0 * max(variance, 0.0)) ** 0.5
    if noise > LOUD * drop and sine > 0.0 and abs(drop / sine - 1.0) > OFF:
        yield (
            f"In noise of {in_words(noise, 'N')} (standard deviation) the drops are not accurate: "
            f"their mean, {in_words(drop, 'N')}, is {percent(abs(drop / sine - 1.0))} "
            f"{'above' if drop > sine else 'below'} that of a sine of the same variance without "
            f"that noise, {in_words(sine, 'N')}."
        )
