"""LabVIEW measurement files (.lvm): headers, a header for each segment, and X values or none.

After the specification by National Instruments, "The LabVIEW Measurement File" (2014).
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from stiction.errors import ResultError
from stiction.formats import TextLayout
from stiction.formats.table import FileColumn, FileTable, Remark
from stiction.formats.text.dialect import Dialect
from stiction.formats.text.lines import lines_of

END = "***End_of_Header***"
SEPARATORS = {"tab": "\t", "comma": ",", "semicolon": ";"}
COLUMN_NAMES = "X_Value"


def read(path: Path, layout: TextLayout) -> list[FileTable]:
    """Return a table for each segment of a LabVIEW measurement file."""
    lines = lines_of(path, layout.largest)
    head, at = _header(path, lines, 0, None)
    mark = SEPARATORS.get(_first(head, "Separator").lower(), "\t")
    sign = layout.decimal or ("," if _first(head, "Decimal_Separator") == "," else ".")
    dialect = Dialect(mark, sign)
    x_columns = (_first(head, "X_Columns") or "One").lower()
    start = f"{_first(head, 'Date')} {_first(head, 'Time')}".strip()
    tables: list[FileTable] = []
    while at < len(lines):
        if not lines[at].strip(mark + " "):
            at += 1
            continue
        segment, at = _header(path, lines, at, dialect)
        end = at + 1
        while end < len(lines) and not lines[end].startswith("Channels" + mark):
            end += 1
        tables.append(_segment(path, lines, at, end, segment, dialect, x_columns, start))
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


def _segment(
    path: Path,
    lines: Sequence[str],
    at: int,
    end: int,
    header: Header,
    dialect: Dialect,
    x_columns: str,
    start: str,
) -> FileTable:
    """Return the table of a segment whose line of names stands at `at`."""
    if at >= len(lines):
        return FileTable((), "LabVIEW measurement")
    names = dialect.cells(lines[at])
    if names and names[-1] == "Comment":
        names.pop()
    rows = [row for row in range(at + 1, end) if lines[row].strip(dialect.separator + " ")]
    cut = bool(rows) and rows[-1] == len(lines) - 1  # no line end: it may be incomplete
    numbers = np.full((len(rows), len(names)), np.nan)
    for each, row in enumerate(rows):
        cells = dialect.cells(lines[row])[: len(names)]
        for column, cell in enumerate(cells):
            if not cell:
                continue
            if not dialect.is_number(cell):
                if cut and row == rows[-1]:
                    break
                raise ResultError(
                    f"{path}: line {row + 1}, column {column + 1}: {cell[:40]!r} is not a number "
                    f"with a decimal {'comma' if dialect.decimal == ',' else 'point'}"
                )
            numbers[each, column] = float(dialect.as_python(cell))
    units, steps = header.get("Y_Unit_Label", []), header.get("Delta_X", [])
    starts, samples = header.get("X0", []), header.get("Samples", [])
    columns, channel = [], 0
    for place, name in enumerate(names):
        if name == COLUMN_NAMES:
            if x_columns != "no":
                unit = "s" if _x_is_time(header) else ""
                columns.append(FileColumn("X_Value", numbers[:, place], place + 1, unit))
            continue
        step, offset = (_number(_at(each, channel), dialect) for each in (steps, starts))
        clock = None
        if x_columns == "no" and np.isfinite(step) and step > 0.0:
            number = np.arange(len(rows), dtype=np.float64)
            clock = (offset if np.isfinite(offset) else 0.0) + step * number
        columns.append(FileColumn(name, numbers[:, place], place + 1, _at(units, channel), clock))
        channel += 1
    promised = [int(each) for each in samples if each.isdigit()]
    began = f"{_first(header, 'Date')} {_first(header, 'Time')}".strip() or start
    remarks = tuple(Remark(0, f"{key}: {' '.join(cells)}") for key, cells in header.items())
    return FileTable(
        tuple(columns),
        "LabVIEW measurement",
        remarks=tuple(x for x in remarks if x.text.startswith(("Notes", "Operator", "Test_"))),
        lines=np.array(rows, dtype=np.intp) + 1,
        notes=(f"{dialect}",),
        promised=max(promised, default=None),
        start=began,
    )


def _x_is_time(header: Header) -> bool:
    return _first(header, "X_Dimension").lower() in ("time", "")


def _at(cells: Sequence[str], place: int) -> str:
    return cells[place] if place < len(cells) else ""


def _number(cell: str, dialect: Dialect) -> float:
    try:
        return float(dialect.as_python(cell))
    except ValueError:
        return float("nan")
