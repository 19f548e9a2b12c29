"""A table of numbers in a text file: columns with names and units, rows with line numbers."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from stiction.errors import DescriptionError, echo
from stiction.machine import shortage

LARGEST = 2**26  # bytes of a file: more than a million rows of two columns
IN_MEMORY = 8.0  # bytes of memory to a byte of the file, while it is read
SHOWN = 4  # lines of one fault
DELIMITERS = (";", "\t", ",")
NAME = re.compile(r"\s*(.*?)\s*(?:[\[(]\s*([^\[\]()]*?)\s*[\])])?\s*")
WORD = re.compile(r"[^\s\[(]+(?:\s*[\[(][^\])]*[\])])?")
COMMENT = "#"


class ColumnHeading(NamedTuple):
    """A column's name and its unit, None if it has none: ``position [mm]``."""

    name: str
    unit: str | None

    def __str__(self) -> str:
        """Return the heading as one writes it."""
        return self.name if self.unit is None else f"{self.name} [{self.unit}]"


class TextTable(NamedTuple):
    """A file's headings, none if it has no line of them, its rows and their line numbers."""

    headings: list[ColumnHeading]
    rows: list[list[str]]
    lines: list[int]


def heading(text: str) -> ColumnHeading:
    """Return name and unit of a heading.

    >>> heading("speed (mm/s)"), heading("t")
    (ColumnHeading(name='speed', unit='mm/s'), ColumnHeading(name='t', unit=None))
    """
    found = NAME.fullmatch(text.strip().strip('"'))
    return ColumnHeading(found[1], found[2]) if found else ColumnHeading(text.strip(), None)


def read_text_table(path: Path) -> TextTable:
    """Read a table whose cells are separated by commas, semicolons, tabs or blanks.

    Lines that begin with # are comments; the last one before the numbers may hold the headings.

    Raises
    ------
    DescriptionError
        If the file cannot be read or holds no rows.
    """
    text = _text(path)
    numbered = [(i, line.strip()) for i, line in enumerate(text.splitlines(), 1) if line.strip()]
    told = [(i, line) for i, line in numbered if not line.startswith(COMMENT)]
    if not told:
        raise file_fault(f"{path.name} holds no rows")
    delimiter = next((each for each in DELIMITERS if each in told[0][1]), None)
    cut = [(i, _cells(line, delimiter)) for i, line in told]
    headings: list[ColumnHeading] = []
    if not any(map(_is_number, cut[0][1])):
        headings = _headings(told[0][1], delimiter)
        cut = cut[1:]
    else:
        above = [line for i, line in numbered if i < cut[0][0]]
        found = _headings(above[-1].lstrip(f"{COMMENT} "), delimiter) if above else []
        headings = found if len(found) == len(cut[0][1]) else []
    if not cut:
        raise file_fault(f"{path.name} holds headings and no rows")
    return TextTable(headings, [cells for _, cells in cut], [i for i, _ in cut])


def find_column(table: TextTable, wanted: ColumnHeading, path: str) -> int:
    """Return the index of the column of a name, or of a number from 1 on.

    Raises
    ------
    DescriptionError
        If there is none, or more than one.
    """
    names = [each.name for each in table.headings]
    for alike in (str, str.lower):
        found = [i for i, name in enumerate(names) if alike(name) == alike(wanted.name)]
        if len(found) == 1:
            return found[0]
        if found:
            raise file_fault(
                f"{len(found)} columns are named {echo(wanted.name)}; rename one", path
            )
    count = len(table.rows[0])
    if wanted.name.isdigit() and 1 <= int(wanted.name) <= count:
        return int(wanted.name) - 1
    known = f"it has {', '.join(names)}" if names else f"it names none: count, 1 to {count}"
    raise file_fault(f"no column {echo(wanted.name)} in the file; {known}", path)


def numbers_in(table: TextTable, index: int, path: str) -> list[float]:
    """Return the numbers of a column.

    Raises
    ------
    DescriptionError
        With the lines that hold none there.
    """
    found: list[float] = []
    wrong: list[tuple[int, str]] = []
    for line, cells in zip(table.lines, table.rows, strict=True):
        try:
            found.append(float(cells[index]))
        except (ValueError, IndexError):
            wrong.append((line, cells[index] if index < len(cells) else ""))
    if wrong:
        raise file_fault(_in_words(wrong), path)
    return found


def _in_words(wrong: Sequence[tuple[int, str]]) -> str:
    lines = ", ".join(str(line) for line, _ in wrong[:SHOWN])
    more = f" and {len(wrong) - SHOWN} more" if len(wrong) > SHOWN else ""
    cell = wrong[0][1][:40]
    what = f"{echo(cell)} is not a number" if cell else "has no number in this column"
    comma = "; the decimal sign is a point" if re.fullmatch(r"[+-]?\d+,\d+.*", cell) else ""
    return f"line {lines}{more}: {what}{comma}; mend the line, or leave it out"


def _headings(line: str, delimiter: str | None) -> list[ColumnHeading]:
    """Return the headings in a line; between blanks, a unit in brackets belongs to its name."""
    cells = _cells(line, delimiter) if delimiter else WORD.findall(line)
    return [heading(cell) for cell in cells]


def _cells(line: str, delimiter: str | None) -> list[str]:
    return [cell.strip().strip('"') for cell in line.split(delimiter)]


def _is_number(text: str) -> bool:
    try:
        float(text.replace(",", "."))
    except ValueError:
        return False
    return True


def _text(path: Path) -> str:
    """Return the text of a file, if it is not too large."""
    try:
        size = path.stat().st_size
        if size > LARGEST:
            raise file_fault(
                f"{path.name} has {size:,} bytes, more than {LARGEST:,}; thin its rows"
            )
        if short := shortage(IN_MEMORY * size):
            raise file_fault(f"{path.name}: reading it {short}; thin its rows")
        with path.open("rb") as file:
            return file.read(LARGEST + 1).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise file_fault(f"{path.name} is not text in UTF-8; export the table as CSV") from None
    except (OSError, ValueError) as error:
        if isinstance(error, DescriptionError):
            raise
        raise file_fault(f"{path.name}: {getattr(error, 'strerror', None) or error}") from None


def file_fault(message: str, path: str = "file") -> DescriptionError:
    """Return the error for a fault of a file, or of the entry of a piece that names it."""
    return DescriptionError.of(path, message)
