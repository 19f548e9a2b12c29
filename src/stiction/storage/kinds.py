"""The kinds of paths, for messages that name the command that takes a path."""

from __future__ import annotations

import re
from importlib import import_module
from os.path import lexists
from pathlib import Path

from stiction.errors import Instruction, argument

HDF5 = b"\x89HDF\r\n\x1a\n"  # the first bytes of HDF5, the format below NetCDF 4
SEEN = 2**16  # bytes that are looked at
TABLE = re.compile(rb"^\s*\[(slider|friction|drive)\b", re.M)
AXES = re.compile(rb"^\s*\[axes\b", re.M)
NUMBERS = re.compile(rb"^\s*[-+]?[\d.]+(e[-+]?\d+)?\s*[;,\t ]\s*[-+]?[\d.]", re.M | re.I)

DESCRIPTION, STUDY, STORE, RESULT, RECORD = "description", "study", "store", "result", "record"
READY = {  # the room of what has a name of its own in place of a file, and what takes the name
    "stiction.presets": Instruction(
        "it is a published system: st.presets.{function}() in Python; stiction run --preset {name} "
        "-o {name}.nc simulates it, and stiction init {name}.toml --preset {name} writes a file of "
        "it",
        "it is a published system: st.presets.{function}() returns it, and "
        "st.init('{name}.toml', preset='{name}') writes a file of it",
    ),
    "stiction.study.presets": Instruction(
        "it is a ready study: stiction sweep --preset {name} -o {name}.zarr runs it",
        "it is a ready study: in a terminal, stiction sweep --preset {name} -o {name}.zarr runs it",
    ),
}
USES = {
    DESCRIPTION: Instruction(
        "it is a description; stiction run {path} -o {stem_nc} simulates it",
        "it is a description; st.run({text}) simulates it",
    ),
    STUDY: Instruction(
        "it describes a study; stiction sweep {path} -o {stem_zarr} runs it",
        "it describes a study; st.sweep(st.Study.from_toml({text}), '{stem}.zarr') runs it",
    ),
    STORE: Instruction(
        "it is the store of a study; stiction map {path} draws it, and st.open_study reads it, "
        "whose to_dataframe() is a table",
        "it is the store of a study; st.map({text}) draws it, and st.open_study({text}) reads it, "
        "whose to_dataframe() is a table",
    ),
    RESULT: Instruction(
        "it is a result or a record; stiction analyse {path} takes either",
        "it is a result or a record; st.analyse({text}) takes either",
    ),
    RECORD: Instruction(
        "it seems to be a measured record; stiction analyse or st.read_record reads it, whose "
        "export(...) writes a table",
        "it seems to be a measured record; st.analyse or st.read_record reads it, whose "
        "export(...) writes a table",
    ),
}


def use_of(path: str | Path, *wanted: str) -> str:
    """Return the content of a path instead of the `wanted` kind, and its use; '' if unknown.

    Where nothing is there, the path may be the name of something ready, see `use_of_name`.
    """
    kind = kind_of(Path(path))
    if kind is None and not lexists(path):
        return use_of_name(Path(path).stem)
    if kind is None or kind in wanted:
        return ""
    stem = Path(path).stem
    made = {f"stem_{suffix}": argument(f"{stem}.{suffix}") for suffix in ("nc", "zarr")}
    made |= {"stem": stem, "text": repr(str(path))}
    return str(USES[kind]).format(path=argument(path), **made)


def use_of_name(name: str) -> str:
    """Return the use of the name of a published system or a ready study; '' of other names.

    Examples
    --------
    >>> use_of_name("leine-belt").partition(", ")[0]
    'it is a published system: st.presets.leine_belt() returns it'
    """
    known, function = name.lower().replace("_", "-"), name.lower().replace("-", "_")
    for room, use in READY.items():  # imported when called: they are above this room
        if known in import_module(room).PRESETS:
            return str(use).format(name=known, function=function)
    return ""


def kind_of(path: Path) -> str | None:
    """Return the kind of a path's content, as far as its beginning shows."""
    try:
        if path.is_dir():
            return STORE if (path / "zarr.json").is_file() else None
        with path.open("rb") as file:
            head = file.read(SEEN)
    except (OSError, ValueError):
        return None
    if head.startswith(HDF5):
        return RESULT
    if b"\0" in head:  # no text
        return None
    if TABLE.search(head):
        return STUDY if AXES.search(head) else DESCRIPTION
    return RECORD if NUMBERS.search(head) else None
