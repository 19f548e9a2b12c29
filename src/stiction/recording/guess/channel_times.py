"""Times of a channel: those of the force, or a clock of its own, to which it is interpolated."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stiction.arrays import Floats
from stiction.formats.channels import CHANNELS
from stiction.formats.table import FileTable, number_of
from stiction.recording.guess.choice import Choice, own_clock
from stiction.recording.guess.clock import Block, check_stated
from stiction.recording.guess.remarks import Said
from stiction.text.quantity.wording import in_words

FEWEST_SAMPLES = 2  # samples of a block
UNEVEN = 0.01  # relative: intervals that differ by more are reported


def times_of_rows(table: FileTable, choice: Choice, interval: float | None) -> tuple[Floats, str]:
    """Return the times of all rows, s, and the name of their column."""
    chosen = choice.channels.get("time")
    if chosen is not None:
        return chosen.column.values * chosen.size, f"column {chosen.column}"
    force = choice.channels["force"].column
    if force.clock is not None:
        return force.clock, "the clock"
    assert interval is not None
    return np.arange(len(table), dtype=np.float64) * interval, "the clock"


def notes_on_times(
    table: FileTable, part: Block, said: Said, by_interval: bool, parts: int
) -> list[str]:
    """Return how times are found, and whether as many are there as the file says."""
    if by_interval:
        notes = [f"times are the number of the sample times {said.stated or 'the interval'}"]
    else:
        notes = [*check_stated(part.time, said.interval, said.stated)]
    promised, count = said.promised or table.promised, len(part.rows)
    if promised is not None and promised > count and (parts == 1 or said.promised):
        notes.append(f"the file promises {promised} samples and has {count}: it is cut off")
    return notes


def own_times(
    path: Path, table: FileTable, choice: Choice, name: str, part: Block
) -> Floats | None:
    """Return the times of a channel with its own clock; None if it shares the force's."""
    column, force = choice.channels[name].column, choice.channels["force"].column
    if column.clock is not None and force.clock is not None:
        own = column.clock[part.rows]
        return None if np.array_equal(own, part.time) else own
    chosen = choice.channels.get("time")
    if chosen is None:
        return None
    times = [
        x for x in table.columns if x.name == chosen.column.name and x.unit == chosen.column.unit
    ]
    if len(times) < 2:
        return None
    clock = own_clock(path, table, column, times)
    own = clock.values[part.rows] * chosen.size
    return None if np.array_equal(own, part.time, equal_nan=True) else own


def values_at(
    values: Floats,
    own: Floats,
    time: Floats,
    name: str,
    whole: NDArray[np.bool_],
) -> tuple[Floats | None, list[str]]:
    """Return a channel at the times of the force, None if it has no values there; and notes."""
    known = np.isfinite(values) & np.isfinite(own)
    if len(own) == len(whole) and known[whole].all() and np.array_equal(own[whole], time):
        return np.asarray(values[whole]), []
    meaning = CHANNELS[name].meaning
    if np.count_nonzero(known) < FEWEST_SAMPLES:
        return None, [f"the {meaning} has no values and is left out"]
    notes = [f"the {meaning} is interpolated to the times of the force by straight lines"]
    order = np.argsort(own[known], kind="stable")
    at, its = own[known][order], values[known][order]
    outside = int(np.count_nonzero((time < at[0]) | (time > at[-1])))
    if outside:
        count = number_of(outside, "sample")
        notes.append(f"{count} outside its times: its first and last value stand there")
    return np.interp(time, at, its), notes


def note_uneven(time: Floats) -> list[str]:
    """Return a note on intervals that differ."""
    steps = np.diff(time)[1:]
    usual = float(np.median(steps)) if len(steps) else 0.0
    if usual <= 0.0 or float(np.abs(steps - usual).max()) <= UNEVEN * usual:
        return []
    least, most = (in_words(float(x), "s") for x in (steps.min(), steps.max()))
    return [f"intervals differ: {least} to {most}, mostly {in_words(usual, 's')}"]
