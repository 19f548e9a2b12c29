"""From a file, or from the numbers in a description, to the rows of a recorded piece."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from pydantic_core import PydanticCustomError

from stiction.drive.recorded.piece import KINDS, Recorded, RecordedLoad, Rows, row_faults
from stiction.drive.recorded.table_file import (
    ColumnHeading,
    TextTable,
    file_fault,
    find_column,
    heading,
    numbers_in,
    read_text_table,
)
from stiction.errors import DescriptionError, Fault, echo
from stiction.storage.checksums import crc
from stiction.storage.foreign import is_within
from stiction.text.samples import FrozenColumn
from stiction.text.units import to_si

# from the name of a file in a description to its path, or a `DescriptionError`
Locate = Callable[[str], Path]
QUANTITIES = {"drive": ("velocity", "position"), "load": ("load",)}
USUAL = {"time": ("time", "t")}  # names of a column that need not be given
PIECE = "recorded"
STAND_IN = {"piece": "hold", "duration": 1.0}


def read_recorded(
    file: str | Path,
    *,
    time: str | None = None,
    velocity: str | None = None,
    position: str | None = None,
    load: str | None = None,
    scale: float = 1.0,
) -> Recorded | RecordedLoad:
    """Read a recorded drive or load from a table in a text file.

    Columns have a name and a unit, ``t [ms]``; a unit that the file's headings lack is given here.
    Columns without a name go by number: ``"2 [mm/s]"``.

    Parameters
    ----------
    file : str or Path
        Cells separated by commas, semicolons, tabs or blanks; lines that begin with # are comments.
    time, velocity, position, load : str, optional
        Names of the columns: by default those named ``time`` (or ``t``), and ``velocity``,
        ``position`` or ``load``, whichever there is.
    scale : float, optional
        What the values are multiplied with.

    Raises
    ------
    DescriptionError
        With every fault of the file, and its lines.

    Examples
    --------
    >>> import stiction as st
    >>> rows = [f"{0.1 * i},{1 + 0.2 * i - 0.01 * i**2}" for i in range(20)]
    >>> with open("stage.csv", "w") as file:
    ...     print("time [s],velocity [mm/s]", *rows, sep=chr(10), file=file)
    >>> round(st.protocols.read_recorded("stage.csv").duration, 6)
    1.9
    """
    given = {"time": time, "velocity": velocity, "position": position, "load": load}
    names = {name: each for name, each in given.items() if each is not None}
    known = tuple(name for names in QUANTITIES.values() for name in names)
    columns, found = rows_of(Path(file), names, known)
    if found:
        raise DescriptionError(found)
    kind = RecordedLoad if "load" in columns else Recorded
    return kind(**columns, scale=scale, file=Path(file).name)


def locator(folder: Path, trust: bool = False) -> Locate:
    """Return how the files of a description are found: in `folder`, with `trust` anywhere."""

    def locate(file: str) -> Path:
        path = Path(os.path.realpath(folder / file))
        if not trust and not is_within(folder, path):
            raise file_fault(
                f"{echo(file)} lies outside the folder of the description, {folder}: put the table "
                "into it; or, if you trust who wrote this, allow it: trust=True, on the command "
                "line --trust"
            )
        if not path.is_file():
            raise file_fault(f"no file {echo(file)} in {folder}; write its path from there")
        return path

    return locate


def locate_nothing(file: str) -> Path:
    """Refuse every file: what is stored holds its tables."""
    raise file_fault(
        f"the rows of {echo(file)} are not stored here; read the description it came from"
    )


def with_rows(raw: Mapping[str, Any], locate: Locate) -> tuple[Mapping[str, Any], list[Fault]]:
    """Return the tables of a description with the rows of its recorded pieces, and all faults.

    In the tables that are returned, another piece stands in for one whose rows have faults.
    """
    tables, found = dict(raw), []
    for name, quantities in QUANTITIES.items():
        program = raw.get(name, {}).get("program") if isinstance(raw.get(name), Mapping) else None
        if not isinstance(program, list | tuple):
            continue
        pieces = []
        for i, piece in enumerate(program, 1):
            if not isinstance(piece, Mapping) or piece.get("piece") != PIECE:
                pieces.append(piece)
                continue
            made, wrong = _with_own_rows(dict(piece), quantities, locate)
            found += [each._replace(path=f"{name}.program.{i}.{each.path}") for each in wrong]
            pieces.append(STAND_IN if wrong else made)
        tables[name] = {**raw[name], "program": pieces}
    return tables, found


def _with_own_rows(
    piece: dict[str, Any], quantities: tuple[str, ...], locate: Locate
) -> tuple[dict[str, Any], list[Fault]]:
    """Return a piece with its rows, which are read from its file unless they are there."""
    stated = piece.pop("checksum", None)
    file = piece.get("file")
    inside = any(isinstance(piece.get(name), list | tuple) for name in ("time", *quantities))
    if file is None or inside:
        found = []
    elif not isinstance(file, str):
        found = [Fault("file", f"{echo(file)} is not the name of a file")]
    else:
        names = {name: piece.pop(name) for name in ("time", *quantities) if name in piece}
        wrong = [name for name, each in names.items() if not isinstance(each, str)]
        found = [
            Fault(name, f"{echo(names[name])} is not a column; write 't [ms]'") for name in wrong
        ]
        if not found:
            try:
                columns, found = rows_of(locate(file), names, quantities)
            except DescriptionError as error:
                columns, found = {}, list(error.faults)
            own = Path(file).name if Path(file).is_absolute() else file  # as of a law's file
            piece |= {**columns, "file": own}
    if stated is not None and not found and checksum(piece) != stated:
        message = (
            f"the rows have the checksum {checksum(piece)}, not {echo(stated)}: they have changed"
        )
        found = [Fault("checksum", f"{message}; leave it out, if that is meant")]
    return piece, found


def checksum(piece: Mapping[str, Any]) -> str:
    """Return the checksum of the rows of a piece."""
    columns = [piece[name] for name in KINDS if piece.get(name) is not None]
    try:
        marks = [FrozenColumn(getattr(each, "values", each)).mark for each in columns]
    except (TypeError, ValueError):
        return "none"
    return f"{crc(b''.join(mark.to_bytes(4, 'little') for mark in marks)):08x}"


def rows_of(
    path: Path, names: Mapping[str, str], quantities: tuple[str, ...]
) -> tuple[dict[str, FrozenColumn], list[Fault]]:
    """Return the columns of a file in SI by their quantity, and all faults.

    `names` are those of the columns, as far as they are given, `quantities` those that it may hold.
    """
    try:
        table = read_text_table(path)
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
        rows = Rows(*values, quantity, unit, table.lines, "line")
        found = [Fault(name, message) for name, message in row_faults(rows)]
    return columns, found


def _quantity(table: TextTable, names: Mapping[str, str], quantities: tuple[str, ...]) -> str:
    """Return what is recorded: the one that is given, or the only one among the headings."""
    headings = {each.name.lower() for each in table.headings}
    given = [name for name in quantities if name in names]
    found = given or [name for name in quantities if name in headings]
    if len(found) == 1:
        return found[0]
    if found:
        raise file_fault(f"give either {' or '.join(found)}", found[0])
    has = ", ".join(map(str, table.headings)) or f"{len(table.rows[0])} columns without headings"
    example = _with_unit(quantities[0], ColumnHeading("NAME", None))
    raise file_fault(
        f"missing; name the column, such as {example}; the file has {has}", quantities[0]
    )


def _column(table: TextTable, name: str, given: str | None) -> FrozenColumn:
    """Return a column in SI."""
    wanted = heading(given) if given is not None else _usual(table, name)
    index = find_column(table, wanted, name)
    stated = table.headings[index].unit if table.headings else None
    unit = wanted.unit or stated
    if unit is None:
        remedy = f"write {_with_unit(name, wanted)}"
        raise file_fault(f"the column {echo(wanted.name)} has no unit; {remedy}", name)
    if wanted.unit is not None and stated is not None and wanted.unit != stated:
        message = f"is to be in {wanted.unit}, and the file says {stated}; leave the unit out"
        raise file_fault(message, name)
    try:
        factor = to_si(f"1 {unit}", KINDS[name])
    except PydanticCustomError as error:
        raise file_fault(error.message(), name) from None
    return FrozenColumn(np.array(numbers_in(table, index, name)) * factor)


def _usual(table: TextTable, name: str) -> ColumnHeading:
    """Return the heading by which a column goes if none is given."""
    names = [each.name.lower() for each in table.headings]
    usual = next((each for each in USUAL.get(name, ()) if each in names), name)
    return ColumnHeading(usual, None)


def _with_unit(name: str, wanted: ColumnHeading) -> str:
    return f'{name} = "{wanted.name} [{KINDS[name].unit}]"'
