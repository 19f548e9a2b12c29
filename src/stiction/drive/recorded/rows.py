"""Faults of the rows of a table: each kind once, with the rows that have it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from stiction.arrays import Floats
from stiction.drive.recorded.resolution import advice, roughness
from stiction.drive.recorded.spline import spline
from stiction.text.samples import FrozenColumn
from stiction.text.units import LARGEST, in_words

FEWEST = 4  # rows, which fix a cubic
MOST = 1_000_000  # rows
GAP = 10.0  # of the distances beside it
SHOWN = 4  # rows of one fault


class Rows(NamedTuple):
    """Times (s) and values of a table in SI, as it is given.

    `name` is what the values are, `unit` the unit of what counts: the velocity's for positions;
    `numbers` count the rows, each of which is a `word`: a line of a file, or a row.
    """

    time: Floats
    values: Floats
    name: str
    unit: str
    numbers: Sequence[int]
    word: str = "row"


def row_faults(table: Rows) -> Iterator[tuple[str, str]]:
    """Yield every fault of a table: the column, and what is wrong with it."""
    time, values = table.time, table.values
    if len(time) != len(values):
        message = f"has {len(values)} rows and time has {len(time)}; give one value for each time"
        yield table.name, message
        return
    found = [*_count(table), *_numbers(table), *_order(table)]
    yield from found
    if not found:
        gaps = [*_gaps(table)]
        yield from gaps or _roughness(table)


def _count(table: Rows) -> Iterator[tuple[str, str]]:
    count = len(table.time)
    if count < FEWEST:
        yield "time", f"has {count} rows; a smooth curve needs {FEWEST} at least"
    if count > MOST:
        yield "time", f"has {count:,} rows, more than {MOST:,}; thin them, or cut the record"


def _numbers(table: Rows) -> Iterator[tuple[str, str]]:
    for name, column in (("time", table.time), (table.name, table.values)):
        wrong = np.flatnonzero(~(np.abs(column) <= LARGEST))
        if len(wrong):
            where = _where(table, wrong)
            yield name, f"{where}: {column[wrong[0]]:g} is not a number; leave the row out"


def _order(table: Rows) -> Iterator[tuple[str, str]]:
    steps = np.diff(table.time)
    back, same = np.flatnonzero(steps < 0.0) + 1, np.flatnonzero(steps == 0.0) + 1
    if len(back):
        i = back[0]
        now, before = table.time[i], table.time[i - 1]
        where = _where(table, back)
        yield "time", f"{where}: {now:.9g} s comes after {before:.9g} s; times must increase"
    if len(same):
        at = table.time[same[0]]
        where = _where(table, same)
        yield "time", f"{where}: at {at:.9g} s as the row before; keep one row of each time"


def _gaps(table: Rows) -> Iterator[tuple[str, str]]:
    steps = np.diff(table.time)
    padded = np.concatenate([[0.0], steps, [0.0]])
    beside = np.maximum(padded[:-2], padded[2:])
    wide = np.flatnonzero(steps > GAP * beside)
    if len(wide):
        i = wide[0]
        yield (
            "time",
            f"{_where(table, wide + 1)}: a gap of {in_words(float(steps[i]), 's')} where rows are "
            f"{in_words(float(beside[i]), 's')} apart; a curve across it would be a guess: split "
            "the table there into pieces, with one between them that you know, or fill in rows",
        )


def _roughness(table: Rows) -> Iterator[tuple[str, str]]:
    integrated = table.name == "position"
    made = spline(FrozenColumn(table.time), FrozenColumn(table.values), integrated)
    largest = float(np.abs(made.bounds[:, :2]).max())
    found = roughness(table.time, table.values, largest, integrated)
    if found is not None:
        amount = in_words(found.noise, table.unit, 2)
        yield table.name, advice(found, table.name, amount, [*table.numbers], table.word)


def _where(table: Rows, rows: Any) -> str:
    """Return the rows of a fault by number, the first ones if they are many."""
    shown = ", ".join(str(table.numbers[int(i)]) for i in rows[:SHOWN])
    more = f" and {len(rows) - SHOWN} more" if len(rows) > SHOWN else ""
    return f"{table.word} {shown}{more}"
