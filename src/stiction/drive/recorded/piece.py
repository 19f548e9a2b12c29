"""Pieces of a program that follow a recorded table, and the faults of its rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import BeforeValidator, WithJsonSchema

from stiction.arrays import Floats
from stiction.drive.recorded.resolution import advice, roughness
from stiction.drive.recorded.spline import Recording, recording, spline
from stiction.errors import echo
from stiction.text.quantity.wording import in_words
from stiction.text.samples import FrozenColumn, as_numbers, samples_to_si
from stiction.text.units import (
    FORCE,
    LARGEST_NUMBER,
    LENGTH,
    TIME,
    VELOCITY,
    Kind,
    Number,
    fault,
    unit_on,
)
from stiction.text.validation import validate

FEWEST_ROWS = 4  # rows, which fix a cubic
MOST_ROWS = 1_000_000  # rows
GAP = 10.0  # of the distances beside it
SHOWN_ROWS = 4  # rows of one fault
KINDS = {"time": TIME, "velocity": VELOCITY, "position": LENGTH, "load": FORCE}
COLUMN = {"anyOf": [{"type": "array", "items": {"type": "number"}}, {"type": "string"}]}
PERIOD = 8  # rows of a period that a table shows well


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
    """Yield every fault of a table, with its column."""
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
    if count < FEWEST_ROWS:
        yield "time", f"has {count} rows; a smooth curve needs at least {FEWEST_ROWS}"
    if count > MOST_ROWS:
        yield "time", f"has {count:,} rows, more than {MOST_ROWS:,}; thin them, or cut the record"


def _numbers(table: Rows) -> Iterator[tuple[str, str]]:
    for name, column in (("time", table.time), (table.name, table.values)):
        wrong = np.flatnonzero(~(np.abs(column) <= LARGEST_NUMBER))
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
    shown = ", ".join(str(table.numbers[int(i)]) for i in rows[:SHOWN_ROWS])
    more = f" and {len(rows) - SHOWN_ROWS} more" if len(rows) > SHOWN_ROWS else ""
    return f"{table.word} {shown}{more}"


def _read_column(values: Any, kind: Kind) -> FrozenColumn:
    """Return a column of numbers in SI, or with a unit of their own."""
    if isinstance(values, FrozenColumn):
        return values
    if isinstance(values, str):
        raise fault(f"{echo(values)} names a column, and there is no file")
    return FrozenColumn(as_numbers(samples_to_si(values, unit_on(values) or kind.unit, kind)))


def _reader(kind: Kind) -> BeforeValidator:
    return BeforeValidator(lambda values: _read_column(values, kind))


SCHEMA = WithJsonSchema(COLUMN)
Times = Annotated[Any, _reader(TIME), SCHEMA, "sequence of float (s)"]
Speeds = Annotated[Any, _reader(VELOCITY), SCHEMA, "sequence of float (m/s)"]
Positions = Annotated[Any, _reader(LENGTH), SCHEMA, "sequence of float (m)"]
Loads = Annotated[Any, _reader(FORCE), SCHEMA, "sequence of float (N)"]


@validate
class Recorded(NamedTuple):
    """A recorded velocity of the drive: a smooth curve through the rows of a table.

    Times count from the table's first row, with which the piece starts; it ends with the last.
    `stiction.protocols.read_recorded` reads a file.

    Parameters
    ----------
    time : array
        (n,), s, increasing, of four rows or more; as a text in a description, the name of a
        column of `file`.
    velocity : array, optional
        (n,), m/s.
    position : array, optional
        (n,), m, in place of `velocity`: its slope is that of the curve, no quotient of differences.
    scale : float, optional
        What the velocity is multiplied with.
    file : str, optional
        The file that the rows come from.

    Examples
    --------
    >>> import stiction as st
    >>> t = [0.0, 0.5, 1.0, 1.5, 2.0]
    >>> stage = st.protocols.Recorded(time=t, velocity=[1e-3, 1.2e-3, 1e-3, 0.8e-3, 1e-3])
    >>> stage.duration
    2.0
    """

    time: Times
    velocity: Speeds | None = None
    position: Positions | None = None
    scale: Number = 1.0
    file: str | None = None

    def faults(self) -> Iterator[tuple[str, str]]:
        """Check the rows."""
        if (self.velocity is None) == (self.position is None):
            yield "velocity", "give either velocity or position"
        else:
            yield from row_faults(_table(self))

    @property
    def duration(self) -> float:
        """How long the record is, s."""
        return length(self.time)

    @property
    def frequency(self) -> float:
        """A frequency that the rows show well, Hz."""
        return highest_frequency(self.time)

    def recording(self, start: float) -> Recording:
        """Return the velocity from `start` (s) on."""
        values = self.position if self.velocity is None else self.velocity
        return recording(spline(self.time, values, self.velocity is None, self.scale), start)


@validate
class RecordedLoad(NamedTuple):
    """A recorded normal load: a smooth curve through the rows of a table, as `Recorded`.

    Parameters
    ----------
    time : array
        (n,), s, increasing, of four rows or more; as a text in a description, the name of a
        column of `file`.
    load : array
        (n,), N.
    scale : float, optional
        What the load is multiplied with.
    file : str, optional
        The file that the rows come from.

    Examples
    --------
    >>> import stiction as st
    >>> t = [0.0, 0.5, 1.0, 1.5, 2.0]
    >>> st.protocols.RecordedLoad(time=t, load=[10.0, 10.5, 10.0, 9.5, 10.0]).duration
    2.0
    """

    time: Times
    load: Loads
    scale: Number = 1.0
    file: str | None = None

    def faults(self) -> Iterator[tuple[str, str]]:
        """Check the rows."""
        yield from row_faults(_table(self))

    @property
    def duration(self) -> float:
        """How long the record is, s."""
        return length(self.time)

    @property
    def frequency(self) -> float:
        """A frequency that the rows show well, Hz."""
        return highest_frequency(self.time)

    def recording(self, start: float) -> Recording:
        """Return the load from `start` (s) on."""
        return recording(spline(self.time, self.load, False, self.scale), start)


RECORDS = (Recorded, RecordedLoad)


def _table(piece: Any) -> Rows:
    """Return the rows of a piece for checking."""
    given = (name for name in KINDS if name != "time" and getattr(piece, name, None) is not None)
    name = next(given)
    values = getattr(piece, name).values
    unit = "N" if name == "load" else "m/s"
    return Rows(piece.time.values, values, name, unit, range(1, len(values) + 1))


def length(time: FrozenColumn) -> float:
    """Return the time between the first and the last row, s."""
    return float(time.values[-1] - time.values[0])


def highest_frequency(time: FrozenColumn) -> float:
    """Return the frequency (Hz) whose period has `PERIOD` rows where rows are densest."""
    some = min(PERIOD, len(time.values) - 1)
    return some / PERIOD / float(np.min(time.values[some:] - time.values[:-some]))
