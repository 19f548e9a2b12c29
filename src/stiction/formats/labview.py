"""LabVIEW measurement files (.lvm): headers, a header for each segment, and X values or none.

After the specification by National Instruments, "The LabVIEW Measurement File" (2014).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple, Self

import numpy as np

from stiction.arrays import Floats
from stiction.errors import ResultError
from stiction.formats import TextLayout
from stiction.formats.table import FileColumn, FileTable, Remark
from stiction.formats.text.dialect import DECIMALS, Dialect
from stiction.formats.text.lines import lines_of

END = "***End_of_Header***"
SEPARATORS = {"tab": "\t", "comma": ",", "semicolon": ";"}
X_COLUMN = "X_Value"
OF_CHANNEL = "Y_Unit_Label", "Delta_X", "X0"  # entries of a header, a cell for each


class _LvmFile(NamedTuple):
    """The lines of a file, and the statements of its first header on all segments."""

    path: Path
    lines: Sequence[str]
    dialect: Dialect
    x_columns: str
    start: str

    @classmethod
    def of(cls, path: Path, layout: TextLayout) -> tuple[Self, int]:
        """Return them, and the number of the line after that header."""
        lines = lines_of(path, layout.largest)
        head, at = _header(path, lines, 0, None)
        mark = SEPARATORS.get(_first(head, "Separator").lower(), "\t")
        sign = layout.decimal or ("," if _first(head, "Decimal_Separator") == "," else ".")
        x_columns = (_first(head, "X_Columns") or "One").lower()
        return cls(path, lines, Dialect(mark, sign), x_columns, _start(head)), at


def read(path: Path, layout: TextLayout) -> list[FileTable]:
    """Return a table for each segment of a LabVIEW measurement file."""
    file, at = _LvmFile.of(path, layout)
    lines, mark = file.lines, file.dialect.separator
    tables: list[FileTable] = []
    while at < len(lines):
        if not lines[at].strip(mark + " "):
            at += 1
            continue
        header, at = _header(path, lines, at, file.dialect)
        end = at + 1
        while end < len(lines) and not lines[end].startswith("Channels" + mark):
            end += 1
        tables.append(_segment(file, header, at, end))
        at = end
    return tables


Header = dict[str, list[str]]


def _header(
    path: Path, lines: Sequence[str], at: int, dialect: Dialect | None
) -> tuple[Header, int]:
    """Return the entries of a header, and the number of the line after it."""
    found: Header = {}
    for number in range(at, len(lines)):
        mark = dialect.separator if dialect else "\t"
        if lines[number].startswith(END):
            return found, number + 1
        if dialect is None and "\t" not in lines[number]:
            mark = next((x for x in (";", ",") if x in lines[number]), "\t")
        name, *cells = lines[number].split(mark)
        found[name.strip()] = [cell.strip() for cell in cells]
    raise ResultError(f"{path}: line {at + 1} begins a header that has no end ({END})")


def _first(header: Header, name: str) -> str:
    return next(iter(header.get(name, [])), "")


def _start(header: Header) -> str:
    return f"{_first(header, 'Date')} {_first(header, 'Time')}".strip()


def _segment(file: _LvmFile, header: Header, at: int, end: int) -> FileTable:
    """Return the table of a segment whose line of names stands at `at`."""
    if at >= len(file.lines):
        return FileTable((), "LabVIEW measurement")
    names = file.dialect.cells(file.lines[at])
    if names and names[-1] == "Comment":
        names.pop()
    empty = file.dialect.separator + " "
    rows = [row for row in range(at + 1, end) if file.lines[row].strip(empty)]
    promised = [int(each) for each in header.get("Samples", []) if each.isdigit()]
    remarks = tuple(Remark(0, f"{key}: {' '.join(cells)}") for key, cells in header.items())
    return FileTable(
        tuple(_columns(file, header, names, _numbers(file, rows, len(names)))),
        "LabVIEW measurement",
        remarks=tuple(x for x in remarks if x.text.startswith(("Notes", "Operator", "Test_"))),
        lines=np.array(rows, dtype=np.intp) + 1,
        notes=(f"{file.dialect}",),
        promised=max(promised, default=None),
        start=_start(header) or file.start,
    )


def _numbers(file: _LvmFile, rows: Sequence[int], width: int) -> Floats:
    """Return the numbers in some lines (rows, columns), NaN where none is.

    A last line without an end may be incomplete: it ends with its last number.
    """
    numbers, dialect = np.full((len(rows), width), np.nan), file.dialect
    for its, row in zip(numbers, rows, strict=True):
        for column, cell in enumerate(dialect.cells(file.lines[row])[:width]):
            if not cell:
                continue
            if dialect.is_number(cell):
                its[column] = float(dialect.as_python(cell))
            elif row == len(file.lines) - 1:
                break
            else:
                raise ResultError(
                    f"{file.path}: line {row + 1}, column {column + 1}: {cell[:40]!r} is not a "
                    f"number with a decimal {DECIMALS[dialect.decimal]}"
                )
    return numbers


def _columns(
    file: _LvmFile, header: Header, names: Sequence[str], numbers: Floats
) -> Iterator[FileColumn]:
    """Yield the columns of a segment, channels with the clock that its header states."""
    channel, without_x = 0, file.x_columns == "no"
    for place, name in enumerate(names):
        values = numbers[:, place]
        if name == X_COLUMN:
            if not without_x:
                yield FileColumn(name, values, place + 1, "s" if _x_is_time(header) else "")
            continue
        unit, *stated = (_at(header.get(key, []), channel) for key in OF_CHANNEL)
        step, offset = (_number(cell, file.dialect) for cell in stated)
        clock = None
        if without_x and np.isfinite(step) and step > 0.0:
            first = offset if np.isfinite(offset) else 0.0
            clock = first + step * np.arange(len(values), dtype=np.float64)
        yield FileColumn(name, values, place + 1, unit, clock)
        channel += 1


def _x_is_time(header: Header) -> bool:
    return _first(header, "X_Dimension").lower() in ("time", "")


def _at(cells: Sequence[str], place: int) -> str:
    return cells[place] if place < len(cells) else ""


def _number(cell: str, dialect: Dialect) -> float:
    try:
        return float(dialect.as_python(cell))
    except ValueError:
        return float("nan")
