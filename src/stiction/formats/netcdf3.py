"""NetCDF of the classic format."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from stiction.formats import TextLayout
from stiction.formats.members import Member, plain_text, tables_of
from stiction.formats.table import FileTable
from stiction.storage.foreign import refuse_size


def read(path: Path, layout: TextLayout) -> list[FileTable]:
    """Return the tables of a NetCDF 3 file."""
    refuse_size(path, 3.0 * path.stat().st_size)
    io: Any = import_module("scipy.io")  # slow to import
    with io.netcdf_file(path, mmap=False) as file:
        members = [
            Member("", name, np.array(each.data), plain_text(getattr(each, "units", "")))
            for name, each in file.variables.items()
        ]
    return tables_of(members, "NetCDF")
