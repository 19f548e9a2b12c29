"""NumPy's files, .npy and .npz, without pickles."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np

from stiction.errors import ResultError
from stiction.formats import TextLayout
from stiction.formats.members import Member, tables_of
from stiction.formats.table import FileTable
from stiction.storage.foreign import refuse_size


def read(path: Path, layout: TextLayout) -> list[FileTable]:
    """Return the tables of a NumPy file; `unit` of a column may stand in its name."""
    with open(path, "rb") as file:
        packed = file.read(2) == b"PK"
    if not packed:
        values = np.load(path, mmap_mode="r", allow_pickle=False)  # bounded by the file's size
        refuse_size(path, 3.0 * values.nbytes)
        return tables_of([Member("", "array", np.array(values))], "NumPy")
    if not zipfile.is_zipfile(path):
        raise ResultError(f"{path}: is a damaged zip archive, or a part of one; copy it again")
    with zipfile.ZipFile(path) as archive:
        names = archive.namelist()
        if not any(name.endswith(".npy") for name in names):
            raise ResultError(f"{path}: is a zip archive without NumPy arrays; unpack it first")
        refuse_size(path, 3.0 * sum(each.file_size for each in archive.infolist()))
    with np.load(path, allow_pickle=False) as arrays:
        return tables_of([Member("", name, arrays[name]) for name in arrays.files], "NumPy")
