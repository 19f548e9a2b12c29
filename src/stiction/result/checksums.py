"""Checksums of everything that is read back from a result file.

Each array has HDF5's own checksum (fletcher32), which every program verifies. It does not protect
names, attributes, or the tables that locate an array in the file: one attribute holds the checksums
of these. The checksum of the whole file stands behind the end of HDF5's data, where no reader
looks. It shows that a file is intact without HDF5, which may crash on damage. Other programs that
write into the file remove it.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from stiction.errors import ResultError
from stiction.result.table import ColumnTable
from stiction.storage.checksums import LENGTH, broken_parts, bytes_of, crc_of_file, seal
from stiction.storage.foreign import opening

SEAL, DESCRIPTION = "checksums", "description"  # attributes of the file
MARK = b"stiction crc-32c"  # precedes the checksum of a whole file


def seal_tables(tables: Mapping[str, ColumnTable]) -> str:
    """Return the checksums of tables as the text of an attribute."""
    return seal(_parts(tables))


def damaged_parts(known: str | None, tables: Mapping[str, ColumnTable]) -> list[str]:
    """Return the names of damaged parts, by the text of `seal_tables`."""
    return [SEAL] if known is None else broken_parts(known, _parts(tables))


def intact_description(path: str | Path) -> str:
    """Return the description from a result file whose other parts are damaged.

    Raises
    ------
    ResultError
        If the description is damaged too, or has no checksum.
    """
    h5py: Any = import_module("h5py")  # slow to import
    lost = "too damaged to be repaired: its description cannot be read; run it again"
    with opening(path, lost), h5py.File(path) as file:
        known, text = str(file.attrs[SEAL]), str(file.attrs[DESCRIPTION])
        whole = DESCRIPTION not in broken_parts(known, {DESCRIPTION: text.encode()})
    if not whole:
        raise ResultError(f"{path}: is damaged, and so is its description; run it again")
    return text


def _parts(tables: Mapping[str, ColumnTable]) -> dict[str, Any]:
    """Return the contents of tables: each array's numbers, and all attributes together."""
    numbers: dict[str, Any] = {}
    attributes: dict[str, Any] = {}
    for name, table in tables.items():
        kept = {key: value for key, value in table.attributes.items() if key != SEAL}
        if DESCRIPTION in kept:
            numbers[DESCRIPTION] = str(kept.pop(DESCRIPTION)).encode()
        attributes[name] = _plain(kept)
        for column, (dims, values, about) in table.columns.items():
            numbers[f"{name}.{column}"] = bytes_of(values)
            attributes[f"{name}.{column}"] = [values.dtype.kind, dims, _plain(about)]
    return {**numbers, "attributes": json.dumps(attributes, sort_keys=True).encode()}


def _plain(attributes: Mapping[Any, Any]) -> dict[str, Any]:
    """Return attributes as plain numbers, texts and lists, independent of the file format."""
    plain = {str(name): np.asarray(value).tolist() for name, value in attributes.items()}
    return {
        name: value[0] if isinstance(value, list) and len(value) == 1 else value
        for name, value in plain.items()
    }


def sign(path: str | Path) -> None:
    """Append a file's checksum to it."""
    own = crc_of_file(path)
    with open(path, "ab") as file:
        file.write(MARK + own)


def as_written(path: str | Path) -> bool | None:
    """Return whether a file matches its appended checksum; None if it has none."""
    end = len(MARK) + LENGTH
    with open(path, "rb") as file:
        size = file.seek(0, os.SEEK_END)
        file.seek(max(size - end, 0))
        mark, own = file.read(len(MARK)), file.read()
    return crc_of_file(path, size - end) == own if mark == MARK else None
