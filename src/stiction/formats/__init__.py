"""Readers of files: each has one file, and one line in `FORMATS`; all return tables of columns."""

from __future__ import annotations

import os
import zipfile
from collections.abc import Callable
from contextlib import suppress
from importlib import import_module
from math import inf
from pathlib import Path
from typing import NamedTuple

from stiction.errors import ResultError
from stiction.formats.table import FileTable
from stiction.storage.foreign import opening
from stiction.storage.kinds import HDF5, RECORD, RESULT, use_of

ZIP = b"PK\x03\x04"  # before each part of an archive
HEAD = 512  # bytes by which a file is recognised
SEARCHED = 1 << 20  # bytes of a damaged archive in which names are sought


class TextLayout(NamedTuple):
    """How a text file is laid out, as far as it is known, and how long it may be."""

    decimal: str | None = None
    separator: str | None = None
    columns: int = 1  # at least
    largest: float = inf  # bytes of text


class Format(NamedTuple):
    """A kind of file: its name, its file here, and how its first bytes are recognised."""

    name: str
    reader: str
    matches: Callable[[bytes], bool]


FORMATS = (
    Format("HDF5", "hdf5", lambda head: head.startswith(HDF5)),
    Format("MATLAB 7.3", "hdf5", lambda head: head.startswith(b"MATLAB 7.3")),
    Format("MATLAB 5", "matlab", lambda head: head.startswith(b"MATLAB 5.0")),
    Format("NetCDF 3", "netcdf3", lambda head: head.startswith((b"CDF\x01", b"CDF\x02"))),
    Format("NumPy", "arrays", lambda head: head.startswith((b"\x93NUMPY", ZIP))),
    Format("Parquet", "parquet", lambda head: head.startswith(b"PAR1")),
    Format("TDMS", "tdms", lambda head: head.startswith((b"TDSm", b"TDSh"))),
    Format("LabVIEW measurement", "labview", lambda head: head[:64].find(b"LabVIEW Meas") >= 0),
    Format("text", "text.reading", lambda head: True),
)
TEXTS = ("text", "LabVIEW measurement")  # formats whose rows have lines
OTHERS = {
    b"\xd0\xcf\x11\xe0": "an Excel workbook; save it as CSV",
    b"%PDF": "a PDF; export the numbers as CSV",
    b"\x7fELF": "a program",
    b"BZh": "compressed with bzip2; unpack it first",
    b"\xfd7zXZ": "compressed with xz; unpack it first",
}
# Documents that are zip archives, by what a name in the archive begins with
PACKED = {
    "xl/": "an Excel workbook; save it as CSV",
    "word/": "a Word document; save the numbers as CSV",
    "content.xml": "an OpenDocument file, as of LibreOffice; save it as CSV",
    "Index/": "an Apple Numbers file; export it as CSV",
}


def format_of(path: Path) -> Format:
    """Return the format of a file, by its content and not by its suffix.

    Raises
    ------
    ResultError
        If there is no such file, or its format is not read here.
    """
    if not os.path.isfile(path):
        use = use_of(path)
        if os.path.isdir(path):
            raise ResultError(f"{path}: is a folder; {use or 'name its files'}")
        if os.path.lexists(path):
            raise ResultError(f"{path}: is not a file; name one")
        raise ResultError(f"{path}: no such file; {use or 'name one that is there'}")
    with open(path, "rb") as file:
        head = file.read(HEAD)
    if not head:
        raise ResultError(f"{path}: is empty; record it again")
    for magic, what in OTHERS.items():
        if head.startswith(magic):
            raise ResultError(f"{path}: is {what}")
    if head.startswith(ZIP):
        names = _packed_names(path)
        for begin, what in PACKED.items():
            if any(name.startswith(begin) for name in names):
                raise ResultError(f"{path}: is {what}")
    return next(each for each in FORMATS if each.matches(head))


def read_tables(path: Path, layout: TextLayout) -> list[FileTable]:
    """Return the tables of a file.

    Raises
    ------
    ResultError
        If it cannot be read, with line and column where there are any.
    """
    kind = format_of(path)
    read = import_module(f"{__name__}.{kind.reader}").read
    try:
        with opening(path, f"is not a file of {kind.name} that can be read"):
            tables: list[FileTable] = read(path, layout)
        if not any(len(table) for table in tables):
            raise ResultError(f"{path}: no samples in it ({kind.name}); record it again")
    except ResultError:  # the header of a record may look like a description
        if use := use_of(path, RESULT, RECORD):
            raise ResultError(f"{path}: is not a record; {use}") from None
        raise
    return [table for table in tables if len(table)]


def _packed_names(path: Path) -> list[str]:
    """Return the names in a zip archive; for a damaged one, the names before its parts."""
    with suppress(zipfile.BadZipFile, OSError), zipfile.ZipFile(path) as archive:
        return archive.namelist()
    with open(path, "rb") as file:
        parts = file.read(SEARCHED).split(ZIP)[1:]
    sizes = [int.from_bytes(part[22:24], "little") for part in parts]
    found = [part[26 : 26 + size] for part, size in zip(parts, sizes, strict=True)]
    return [name.decode("utf-8", "replace") for name in found]
