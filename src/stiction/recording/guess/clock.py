"""Times of samples: restarts, intervals in place of times, a first interval unlike the others."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.arrays import Floats, Indices, compute_once
from stiction.errors import Faults, ResultError
from stiction.formats.table import FileTable, number_of
from stiction.text.quantity.wording import in_words
from stiction.text.suggestion import Suggestion

ALIKE_INTERVALS = 1e-3  # relative: intervals, of which the file rounds one
AGAIN = 0.05  # of a block's duration: a time so near its first begins the next block
STEADY = 30.0  # largest of intervals over the smallest
FEW_VALUES = 0.02  # of the samples: with so few different values a column is a clock or a period
FIRST_INTERVAL = 0.01  # relative: how far the first interval may differ from the others
ODD = 3.0  # times as far off as any other interval: it differs by more than jitter
TIED = 0.5  # of the samples with the time of the one before
FALLING = 0.05  # of the steps: times fall where a block begins again, intervals at every other step
ONE_MISSING = 1.75  # steps between two samples: in a longer interval at least one is missing
GAP = 3.0  # medians: longer intervals do not count in the rate; shorter ones may be those of jitter
EVEN_INTERVALS = 0.5  # of their mean: how far the other intervals may spread for that to be sure


class Block(NamedTuple):
    """Indices of one block, and their times, s, from the file's own zero."""

    rows: Indices
    time: Floats
    notes: tuple[str, ...]


def blocks(
    path: object, table: FileTable, time: Floats, said: str | None, name: str
) -> list[Block]:
    """Return the blocks of a table by its times (s): each restart begins another.

    Raises
    ------
    ResultError
        If times go back without beginning again, or may be periods as well.
    """
    rows = np.flatnonzero(np.isfinite(time))
    if not len(rows):
        raise ResultError(f"{path}: the column of times, {name}, has no numbers")
    values, notes = time[rows], []
    if len(rows) < len(time):
        lost = np.flatnonzero(~np.isfinite(time))
        place = table.line(int(lost[0]))
        notes.append(f"{number_of(len(lost), 'sample')} without a time left out, first {place}")
    if said != "clock" and len(values) > 2 and _are_periods(path, values, said, name):
        values = np.cumsum(values) - values[0]
        notes.append(f"{name} holds the interval before each sample: times are their sum")
    back = np.flatnonzero(np.diff(values) < 0.0)
    if len(values) > 2 and len(back) == len(values) - 1:
        raise ResultError(
            f"{path}: the times run backwards, from {values[0]:g} s to {values[-1]:g} s; put the "
            "lines in order"
        )
    found, start, faults = [], 0, Faults()
    for at in [*back.tolist(), len(values) - 1]:
        first, last = float(values[start]), float(values[at])
        if at < len(values) - 1 and values[at + 1] > first + AGAIN * (last - first):
            faults.add(
                f"{path}: {table.line(int(rows[at + 1]))}: the time goes back from {last:g} s to "
                f"{values[at + 1]:g} s and does not begin again; put the lines in order"
            )
            continue
        its = values[start : at + 1]
        found.append(Block(rows[start : at + 1], its, (*notes, *_first_interval(its))))
        start = at + 1
    faults.refuse()
    return found


def _are_periods(path: object, values: Floats, said: str | None, name: str) -> bool:
    """Return whether a column of times holds the period of each sample instead."""
    if said == "intervals":
        return True
    steps = np.diff(values)
    positive = bool((values > 0.0).all())
    steady = positive and float(values.max() / values.min()) < STEADY
    falls = float(np.mean(steps < 0.0))
    ties = float(np.mean(steps == 0.0))
    if steady and (ties == 1.0 or falls > FALLING):
        return True
    # few values, each for many samples: a coarse clock, or a period that changes
    distinct = len(np.unique(values))
    if steady and falls == 0.0 and ties > TIED and distinct <= max(3.0, FEW_VALUES * len(values)):
        raise ResultError(
            f"{path}: {name} has only {distinct} values, {values.min():g} to {values.max():g} s, "
            "in ascending order: the times of a coarse clock, or the interval of each sample? say "
            f"{Suggestion('times', 'clock')} or {Suggestion('times', 'intervals')}"
        )
    return False


@compute_once
def rate_of(time: Floats) -> float:
    """Return the samples per second without gaps; 0 if the times do not determine it.

    It is the average if intervals differ at random.
    """
    steps = np.diff(time)
    if not len(steps) or time[-1] <= time[0]:
        return 0.0
    near = steps[steps <= GAP * np.median(steps)]
    if len(near) < len(steps) and near.std() < EVEN_INTERVALS * near.mean():
        return len(near) / float(near.sum())
    return len(steps) / float(time[-1] - time[0])


def _first_interval(time: Floats) -> list[str]:
    """Return a note if the first interval differs from all others."""
    if len(time) < 5:
        return []
    steps = np.diff(time)
    usual = float(np.median(steps[1:]))
    others = np.abs(steps[1:] - usual).max()
    odd = abs(steps[0] - usual)
    if usual > 0.0 and odd > FIRST_INTERVAL * usual and odd > ODD * others:
        return [
            f"the first interval is {in_words(steps[0], 's')}, the others {in_words(usual, 's')}"
        ]
    return []


def check_stated(time: Floats, interval: float | None, stated: str) -> list[str]:
    """Return a note on how the stated interval agrees with the times, except for rounding."""
    if interval is None or len(time) < 3:
        return []
    usual = float(np.median(np.diff(time)))
    if usual <= 0.0 or abs(interval / usual - 1.0) <= ALIKE_INTERVALS:
        return []
    return [
        f"the file states an interval of {stated}, and its times are {in_words(usual, 's')} apart: "
        "the times are used"
    ]


def spread_evenly(time: Floats) -> Floats:
    """Return increasing times; samples with equal times are spread evenly up to the next time."""
    first = np.flatnonzero(np.diff(time, prepend=time[0] - 1.0))
    count = np.diff(first, append=len(time))
    ends = time[first]  # a copy
    typical = float(np.median(np.diff(ends))) / float(np.median(count[:-1]))
    length = np.append(np.diff(ends), typical * count[-1])
    if typical * count[0] < length[0]:  # the record begins within a tick of its clock
        ends[0], length[0] = ends[0] + length[0] - typical * count[0], typical * count[0]
    number = np.arange(len(time)) - np.repeat(first, count)
    return np.asarray(np.repeat(ends, count) + number * np.repeat(length / count, count))
