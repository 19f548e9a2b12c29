"""Text files of columns: any separator, decimal comma, header lines, units, several blocks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from io import StringIO
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stiction.arrays import Floats, Indices
from stiction.errors import Faults, ResultError, echo
from stiction.formats import TextLayout
from stiction.formats.table import FileColumn, FileTable, Remark, number_of
from stiction.formats.text.cell_units import (
    CellUnit,
    conflict,
    differ_in_size,
    units_of,
    without_units,
)
from stiction.formats.text.dialect import (
    MISSING,
    Dialect,
    find_dialect,
    first_samples,
    is_date_and_clock,
    seconds_of,
)
from stiction.formats.text.heading import Heading, find_heading, repeats
from stiction.formats.text.lines import lines_of
from stiction.formats.units import split_unit
from stiction.storage.foreign import refuse_size

WIDEST = 2000  # columns
LISTED = 5  # places at which lines were skipped
NUMERIC = 0.5  # of a column's cells: with fewer numbers it is one of words


def read(path: Path, layout: TextLayout) -> list[FileTable]:
    """Return the tables of a text file."""
    given = lines_of(path, layout.largest)
    lines = without_units(given)
    dialect = find_dialect(path, lines, layout)
    units = units_of(path, given, dialect) if lines is not given else {}
    return [_with_units(path, table, units) for table in read_lines(path, lines, dialect)]


def _with_units(path: Path, table: FileTable, units: Mapping[int, CellUnit]) -> FileTable:
    """Return a table with the units behind the numbers of its columns.

    Raises
    ------
    ResultError
        If a heading states another unit than the cells below it.
    """
    faults = Faults()
    columns = []
    for each in table.columns:
        behind = units.get(each.number - 1)
        if behind is not None and each.unit and conflict(each.unit, behind.name):
            faults.add(
                f"{path}: line {behind.line}, column {each.number}: has {behind.name} behind its "
                f"number, its heading is {echo(each.heading)}; correct one of them"
            )
        stated = each.unit or (behind.name if behind is not None else "")
        columns.append(replace(each, unit=stated))
    faults.refuse()
    return replace(table, columns=tuple(columns)) if units else table


@dataclass
class _Cells:
    """The cells of all lines from the first with samples on: numbers, and texts that are none."""

    first: int
    numbers: Floats  # (rows, columns), NaN for missing and for text
    texts: dict[int, NDArray[Any]]  # of the columns that are not all numbers
    wrong: NDArray[np.bool_]  # (rows, columns), cells with text


def read_lines(path: Path, lines: Sequence[str], dialect: Dialect) -> list[FileTable]:
    """Return the tables in lines of text.

    Raises
    ------
    ResultError
        If cells among the samples are not numbers, with line and column of each.
    """
    first = first_samples(lines, dialect)
    cells = _read_cells(path, lines, dialect, first)
    words = _word_columns(cells)
    numeric = np.array([at not in words for at in range(cells.numbers.shape[1])])
    faults = Faults()
    kinds = _kinds(path, cells, numeric, faults)
    remarks = [Remark(at + 1, x) for at, x in enumerate(lines[:first]) if x.strip()]
    tables: list[FileTable] = []
    heading: Heading | None = None
    rows: list[Indices] = []
    skipped: list[str] = []

    def close() -> None:
        if rows:
            chosen = np.concatenate(rows)
            _note_longer_rows(path, cells, chosen, heading, faults)
            _note_other_units(path, heading, faults)
            tables.append(_table(cells, chosen, heading, words, remarks, skipped, dialect))

    breaks = np.flatnonzero(np.diff(kinds.astype(np.int8)) != 0) + 1
    for part in np.split(np.arange(len(kinds)), breaks):
        if not len(part):
            continue
        if kinds[part[0]] == DATA:
            if not rows and heading is None:
                heading = find_heading([x.text for x in remarks], dialect, _width(cells, part))
            rows.append(part)
            continue
        said = [Remark(first + at + 1, lines[first + at]) for at in part if kinds[at] == TEXT]
        if not said:
            continue
        again = heading is not None and any(repeats(heading, x.text, dialect) for x in said)
        after = part[-1] + 1
        new = None
        if after < len(kinds) and not again:
            new = find_heading([x.text for x in said], dialect, _width(cells, np.array([after])))
        if new is not None and new.trusted:
            close()
            rows, skipped, heading, remarks = [], [], new, said
            continue
        what = "a repeated header" if again else f"{said[0].text.strip()[:60]!r}"
        many = f" and {number_of(len(said) - 1, 'more line')}" if len(said) > 1 else ""
        skipped.append(f"line {said[0].line} skipped: {what}{many}")
        remarks = [*remarks, *said]
    close()
    faults.refuse()
    return tables


DATA, TEXT, BLANK = 0, 1, 2  # kinds of lines


def _read_cells(path: Path, lines: Sequence[str], dialect: Dialect, first: int) -> _Cells:
    """Read all cells from a line on with pandas, and distinguish numbers from text."""
    import pandas as pd

    part = list(lines[first:])
    while part and not part[-1].strip():
        part.pop()
    by_space = dialect.separator == " "
    width = _columns_of(path, part, dialect, first)
    refuse_size(path, 8.0 * 3.0 * width * len(part))
    # a blank line must remain a row: the numbers of lines are those of rows
    text = "\n".join(x.strip() or (dialect.separator * (not by_space) or "-") for x in part)
    frame = pd.read_csv(
        StringIO(text + "\n"),
        sep=r"\s+" if by_space else dialect.separator,
        decimal=dialect.decimal,
        header=None,
        names=list(range(width)),
        index_col=False,
        skipinitialspace=True,
        skip_blank_lines=False,
        na_values=sorted(MISSING - {""}),
        low_memory=False,
        dtype=None,
    )
    numbers = np.full((len(part), width), np.nan)
    wrong = np.zeros((len(part), width), bool)
    texts: dict[int, NDArray[Any]] = {}
    for at in range(width):
        column = frame[at]
        if column.dtype.kind in "fiu":
            numbers[:, at] = column.to_numpy(dtype=np.float64)
        else:
            texts[at] = column.to_numpy(dtype=object)
            known = np.asarray(column.notna())
            numbers[:, at], wrong[:, at] = _numbers_among(texts[at], known, dialect)
    numbers[np.isinf(numbers)] = np.nan
    return _Cells(first, numbers, texts, wrong)


def _columns_of(path: Path, lines: Sequence[str], dialect: Dialect, first: int) -> int:
    """Return the largest number of cells in a line; refuse lines that cannot be cut into cells."""
    by_space = dialect.separator == " "
    counts = [len(x.split()) if by_space else x.count(dialect.separator) + 1 for x in lines]
    width = max(counts, default=1)
    if width > WIDEST:
        line = first + counts.index(width) + 1
        raise ResultError(f"{path}: line {line} has {width} columns; a record has {WIDEST} at most")
    for at, text in enumerate(lines):
        if '"' in text and text.count('"') % 2:
            raise ResultError(f"{path}: line {first + at + 1} opens a quotation without end")
    return width


def _numbers_among(
    texts: NDArray[Any], known: NDArray[np.bool_], dialect: Dialect
) -> tuple[Floats, NDArray[np.bool_]]:
    """Return the numbers among the texts of a column, NaN elsewhere, and which texts are wrong."""
    import pandas as pd

    plain = [
        dialect.as_python(str(x).strip()) if yes else "nan"
        for x, yes in zip(texts, known, strict=True)
    ]
    numbers = np.array(pd.to_numeric(pd.Series(plain, dtype=object), errors="coerce"), float)
    odd = [
        x.lower() in ("true", "false") or "_" in x or "x" in x or dialect.has_other_sign(str(given))
        for x, given in zip(plain, texts, strict=True)
    ]
    numbers[odd] = np.nan
    missing = np.array([x.lower() in MISSING for x in plain])
    return numbers, known & np.isnan(numbers) & ~missing


def _word_columns(cells: _Cells) -> set[int]:
    """Return the columns in which most cells are words or times of day."""
    filled = cells.wrong | np.isfinite(cells.numbers)
    full = filled.sum(axis=0)
    return {at for at in cells.texts if cells.wrong[:, at].sum() > NUMERIC * full[at] > 0}


def _kinds(
    path: Path, cells: _Cells, numeric: NDArray[np.bool_], faults: Faults
) -> NDArray[np.int8]:
    """Return which lines hold samples; a wrong cell among numbers is a fault."""
    wrong = cells.wrong & numeric
    known = np.isfinite(cells.numbers)
    kinds = np.where(known.any(axis=1), DATA, BLANK).astype(np.int8)
    only_words = ~known.any(axis=1) & cells.wrong.any(axis=1)
    kinds[only_words] = TEXT
    last, lead = len(kinds) - 1, int(np.argmax(numeric))
    for row in np.flatnonzero(wrong.any(axis=1)):
        begins = "0" if known[row, lead] else str(cells.texts[lead][row]).lstrip("+−-.,")
        cut_off = row == last
        if not known[row].any() or not begins[:1].isdigit() or cut_off:
            kinds[row] = TEXT
            continue
        for at in map(int, np.flatnonzero(wrong[row])):
            faults.add(
                f"{path}: line {cells.first + row + 1}, column {at + 1}: "
                f"{str(cells.texts[at][row]).strip()[:40]!r} is not a number; correct it, or take "
                "the line out"
            )
    return kinds


def _width(cells: _Cells, rows: Indices) -> int:
    """Return the number of columns that have values in most of the rows."""
    filled = np.isfinite(cells.numbers[rows]) | cells.wrong[rows]
    used = np.flatnonzero(filled.any(axis=0))
    return int(used[-1]) + 1 if len(used) else 0


def _lines_above(above: Sequence[Remark], heading: Heading | None) -> list[str]:
    """Return a note on the lines above the samples beside names and units."""
    used = 0 if heading is None else 1 + bool(heading.units)
    if len(above) <= used:
        return []
    first = above[0].text.strip()[:60]
    many = number_of(len(above) - used, "line")
    return [f"{many} above the samples beside names and units, first {echo(first)}"]


def _note_longer_rows(
    path: Path, cells: _Cells, rows: Indices, heading: Heading | None, faults: Faults
) -> None:
    """Note each row that has more values than nearly all others."""
    width = _width(cells, rows)
    filled = np.isfinite(cells.numbers[rows, :width]) | cells.wrong[rows, :width]
    count = width - np.argmax(filled[:, ::-1], axis=1) if width else np.zeros(len(rows))
    usual = int(np.median(count)) if len(rows) else 0
    extra = np.flatnonzero(count > usual)
    named = len(heading.names) if heading is not None else 0
    if len(extra) >= 0.1 * len(rows) or usual < named:
        return
    for at in extra:
        faults.add(
            f"{path}: line {cells.first + rows[at] + 1}, column {usual + 1}: has {int(count[at])} "
            f"values, the others have {usual}; correct it, or take the line out"
        )


def _note_other_units(path: Path, heading: Heading | None, faults: Faults) -> None:
    """Note each column whose heading states another size of its unit than the units below it.

    A line that leaves out a column whose heading has a unit may be a remark.
    """
    if heading is None:
        return
    below = (split_unit(f"x [{unit}]")[1] for unit in heading.units)
    pairs = [*zip_longest((split_unit(name)[1] for name in heading.names), below, fillvalue="")]
    if any(own and not unit for own, unit in pairs):
        return
    for at, (own, unit) in enumerate(pairs):
        if own and differ_in_size(own, unit):
            faults.add(
                f"{path}: column {at + 1}: its heading is {echo(heading.names[at])}, the line of "
                f"units below has {echo(heading.units[at])}; correct one of them"
            )


def _unnamed_date(cells: _Cells, rows: Indices, heading: Heading | None, width: int) -> int:
    """Return the column of dates that shares its name with the clocks beside it; else `width`.

    Spaces between columns cut a date from its time of day.
    """
    if heading is None or len(heading.names) != width - 1:
        return width
    firsts = {at: str(x[rows[0]]).strip() for at, x in cells.texts.items() if at < width}
    both = (at for at, x in firsts.items() if is_date_and_clock(x, firsts.get(at + 1, "")))
    return next(both, width)


def _table(
    cells: _Cells,
    rows: Indices,
    heading: Heading | None,
    words: set[int],
    remarks: Sequence[Remark],
    skipped: Sequence[str],
    dialect: Dialect,
) -> FileTable:
    """Return the table of some rows."""
    width = _width(cells, rows)
    above = [x for x in remarks if x.line < cells.first + rows[0] + 1]
    more = [f"and {number_of(len(skipped) - LISTED, 'more skip')}"] if len(skipped) > LISTED else []
    notes = [f"{dialect}", *_lines_above(above, heading), *skipped[:LISTED], *more]
    columns, labels, start = [], [], ""
    day = _unnamed_date(cells, rows, heading, width)
    for at in range(width):
        place = at - (at > day)
        name, unit = heading.of(place) if heading is not None else (f"column {at + 1}", "")
        values = np.ascontiguousarray(cells.numbers[rows, at])
        if at in words:
            texts = np.asarray(cells.texts[at][rows], dtype=object)
            seconds = seconds_of(texts.tolist())
            if seconds is None:
                labels.append((name, texts))
                continue
            start = next(
                (str(x).strip() for x in texts if str(x).strip().lower() not in MISSING), ""
            )
            values, unit = seconds - seconds[np.isfinite(seconds)][0], "s"
        columns.append(FileColumn(name, values, at + 1, unit))
    lines = np.asarray(cells.first + rows + 1, dtype=np.intp)
    return FileTable(
        tuple(columns),
        "text",
        remarks=tuple(remarks),
        lines=lines,
        notes=tuple(notes),
        start=start,
        labels=tuple(labels),
    )
