"""From a file, or from the numbers in a description, to the rows of a recorded piece."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from stiction.drive.recorded.piece import KINDS, Recorded, RecordedLoad
from stiction.errors import DescriptionError, Fault, echo
from stiction.storage.checksums import crc
from stiction.storage.foreign import is_within
from stiction.text.samples import FrozenColumn
from stiction.text.suggestion import TRUST

# from the name of a file in a description to its path, or a `DescriptionError`
Locate = Callable[[str], Path]
QUANTITIES = {"drive": ("velocity", "position"), "load": ("load",)}
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
        Of text, as `stiction.read_record` reads it: any separator and decimal sign, headings and
        lines above them; lines that begin with # are comments.
    time, velocity, position, load : str, optional
        Names of the columns: by default those named ``time`` (or ``t``, or as instruments call
        it), and ``velocity``, ``position`` or ``load``, whichever there is.
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
    from stiction.drive.recorded.columns import rows_of  # readers of files are slow to import

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
            raise DescriptionError.of(
                "file",
                f"{echo(file)} lies outside the folder of the description, {folder}: put the table "
                f"into it; or, if you trust who wrote this, allow it: {TRUST}",
            )
        if not path.is_file():
            message = f"no file {echo(file)} in {folder}; write its path from there"
            raise DescriptionError.of("file", message)
        return path

    return locate


def locate_nothing(file: str) -> Path:
    """Refuse every file, since stored results contain their tables."""
    message = f"the rows of {echo(file)} are not stored here; read the description it came from"
    raise DescriptionError.of("file", message)


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
            from stiction.drive.recorded.columns import rows_of

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
