"""The columns of a file of text that recorded drives and loads follow, in SI."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from itertools import takewhile
from pathlib import Path

from pydantic_core import PydanticCustomError

from stiction.drive.recorded.piece import KINDS, SHOWN_ROWS, Rows, row_faults
from stiction.errors import DescriptionError, Fault, ResultError, echo, visible
from stiction.formats import TEXTS, TextLayout, format_of, read_tables
from stiction.formats.channels import CHANNELS, plain
from stiction.formats.table import FileColumn, FileTable
from stiction.formats.text.dialect import UnclearCommas
from stiction.formats.text.heading import COMMENT
from stiction.formats.units import split_unit
from stiction.text.samples import FrozenColumn
from stiction.text.units import to_si

LARGEST_TEXT = 2**26  # bytes of text: more than a million rows of two columns
PLAIN = "write points as decimal signs, no sign between thousands, and tabs between columns"
TIME_NAMES = ("time", "t")  # of several names of times
# a unit that is none stands in brackets, too
BRACKETS = re.compile(r"(.*?)\s*[\[(]\s*([^\[\]()]*?)\s*[\])]")
NUMBERED = re.compile(r"\s*[+−-]?[.,]?\d")  # a line that begins with a number


def rows_of(
    path: Path, names: Mapping[str, str], quantities: tuple[str, ...]
) -> tuple[dict[str, FrozenColumn], list[Fault]]:
    """Return the columns of a file in SI by their quantity, and all faults.

    `names` are those of the columns, as far as they are given, `quantities` those that it may hold.
    """
    try:
        table = _table(path)
        quantity = _quantity(table, names, quantities)
    except DescriptionError as error:
        return {}, list(error.faults)
    columns: dict[str, FrozenColumn] = {}
    found: list[Fault] = []
    for name in ("time", quantity):
        try:
            columns[name] = _column(table, name, names.get(name))
        except DescriptionError as error:
            found += error.faults
    if not found:
        unit = "N" if quantity == "load" else "m/s"
        values = columns["time"].values, columns[quantity].values
        rows = Rows(*values, quantity, unit, _lines(table), "line")
        found = [Fault(name, message) for name, message in row_faults(rows)]
    return columns, found


def _table(path: Path) -> FileTable:
    """Return the only table of a file of text, in which no row is damaged.

    Raises
    ------
    DescriptionError
        With every fault of the file.
    """
    try:
        if (kind := format_of(path)).name not in TEXTS:
            raise ResultError(f"{path}: is a file of {kind.name}; export the table as text")
        tables = read_tables(path, TextLayout(columns=2, largest=LARGEST_TEXT))
    except OSError as error:
        raise _fault(f"{path.name}: {error.strerror or error}") from None
    except UnclearCommas as error:
        unclear = error.unclear.removeprefix(f"{path}: ")
        raise _fault(f"{path.name}: {unclear}; {PLAIN}") from None
    except ResultError as error:
        lines = (line.removeprefix(visible(f"{path}: ")) for line in str(error).splitlines())
        raise DescriptionError([Fault("file", f"{path.name}: {line}") for line in lines]) from None
    if len(tables) > 1:
        second = tables[1].line(0)
        raise _fault(f"{path.name} holds {len(tables)} tables, the second from {second}; leave one")
    _refuse_damage(tables[0])
    return tables[0]


def _refuse_damage(table: FileTable) -> None:
    """Refuse lines that may have been rows: among them, or just above with a number first."""
    first = _lines(table)[0]
    said = [each for each in table.remarks if not COMMENT.match(each.text)]
    above = [each for each in reversed(said) if each.line < first]
    wrong = [*takewhile(lambda each: NUMBERED.match(each.text), above)][::-1]
    wrong += [each for each in said if each.line > first]
    if wrong:
        lines = ", ".join(str(each.line) for each in wrong[:SHOWN_ROWS])
        more = f" and {len(wrong) - SHOWN_ROWS} more" if len(wrong) > SHOWN_ROWS else ""
        text = echo(wrong[0].text.strip()[:40])
        raise _fault(f"line {lines}{more}: {text} is not a row; mend the line, or leave it out")


def _lines(table: FileTable) -> Sequence[int]:
    """Return the line of each row."""
    lines: Sequence[int] = [] if table.lines is None else table.lines.tolist()
    return lines


def _quantity(table: FileTable, names: Mapping[str, str], quantities: tuple[str, ...]) -> str:
    """Return the recorded quantity: the one that is given, or the only one in the headings."""
    headings = {_heading(each)[0].lower() for each in table.columns}
    given = [name for name in quantities if name in names]
    found = given or [name for name in quantities if name in headings]
    if len(found) == 1:
        return found[0]
    if found:
        raise _fault(f"give either {' or '.join(found)}", found[0])
    example = _with_unit(quantities[0], "NAME")
    raise _fault(
        f"missing; name the column, such as {example}; the file has {_headings(table.columns)}",
        quantities[0],
    )


def _column(table: FileTable, name: str, given: str | None) -> FrozenColumn:
    """Return a column in SI."""
    wanted, asked = (_usual(table, name), "") if given is None else _split(given)
    column = _find(table, wanted, name)
    stated = _heading(column)[1]
    if not (asked or stated):
        raise _fault(
            f"the column {echo(wanted)} has no unit; write {_with_unit(name, wanted)}", name
        )
    if asked and stated and asked != stated:
        raise _fault(f"is to be in {asked}, and the file says {stated}; leave the unit out", name)
    try:
        factor = to_si(f"1 {asked or stated}", KINDS[name])
    except PydanticCustomError as error:
        raise _fault(error.message(), name) from None
    return FrozenColumn(column.values * factor)


def _usual(table: FileTable, name: str) -> str:
    """Return the default name of a column; for times, the name in records."""
    if name != "time":
        return name
    usual = CHANNELS[name].names
    found = [each for each in table.columns if usual.fullmatch(plain(_heading(each)[0]))]
    named = [_heading(each)[0] for each in found]
    first = [each for wanted in TIME_NAMES for each in named if each.lower() == wanted]
    if len({*named}) > 1 and not first:
        raise _fault(f"may be any of {_headings(found)}; name one", name)
    return next(iter(first or named), name)


def _find(table: FileTable, wanted: str, path: str) -> FileColumn:
    """Return the column of a name, or of a number from 1 on."""
    for alike in (str, str.lower):
        found = [x for x in table.columns if alike(_heading(x)[0]) == alike(wanted)]
        if len(found) == 1:
            return found[0]
        if found:
            raise _fault(f"{len(found)} columns are named {echo(wanted)}; rename one", path)
    for column in table.columns:
        if wanted == str(column.number):
            return column
    known = _headings(table.columns)
    raise _fault(f"no column {echo(wanted)} in the file; it has {known}", path)


def _heading(column: FileColumn) -> tuple[str, str]:
    """Return name and unit of a column."""
    return (column.name, column.unit) if column.unit else _split(column.name)


def _split(heading: str) -> tuple[str, str]:
    """Return name and unit of a heading, '' if it has none.

    >>> _split("Weg (mm)"), _split("2 [mm/s]"), _split("v [furlong]"), _split("t")
    (('Weg', 'mm'), ('2', 'mm/s'), ('v', 'furlong'), ('t', ''))
    """
    name, unit = split_unit(heading)
    unknown = None if unit else BRACKETS.fullmatch(name)
    return (unknown[1], unknown[2]) if unknown else (name, unit)


def _headings(columns: Sequence[FileColumn]) -> str:
    return ", ".join(each.heading for each in columns)


def _with_unit(name: str, wanted: str) -> str:
    return f'{name} = "{wanted} [{KINDS[name].unit}]"'


def _fault(message: str, path: str = "file") -> DescriptionError:
    """Return the error for a fault of a file, or of the entry of a piece that names it."""
    return DescriptionError.of(path, message)
