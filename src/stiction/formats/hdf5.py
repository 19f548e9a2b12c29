"""HDF5 and the formats based on it: NetCDF 4, MATLAB 7.3."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from stiction.formats import TextLayout
from stiction.formats.members import Member, plain_text, tables_of
from stiction.formats.table import FileTable, natural_key
from stiction.storage.foreign import read_through, refuse_other_files
from stiction.storage.isolation import apart

UNITS = ("units", "unit", "Units", "Unit")
HIDDEN = ("#refs#", "#subsystem#")  # of MATLAB


def read(path: Path, layout: TextLayout) -> list[FileTable]:
    """Return the tables of an HDF5 file: a table for each group and length."""
    apart(read_through, path)  # damage may crash HDF5
    refuse_other_files(path)
    h5py: Any = import_module("h5py")  # slow to import
    with h5py.File(path) as file:
        kind = "HDF5"
        if "MATLAB_class" in repr([list(each.attrs) for each in file.values()]):
            kind = "MATLAB 7.3"
        elif "_NCProperties" in file.attrs:
            kind = "NetCDF"
        return tables_of(_members(file, "", kind), kind)


def _members(group: Any, path: str, kind: str) -> Iterator[Member]:
    for key, value in group.attrs.items():
        if np.size(value) == 1 and not key.startswith(("_", "MATLAB", "H5")):
            yield Member(path, key, np.asarray(value).astype(str))
    for name in sorted(group, key=natural_key):
        each = group[name]
        if name in HIDDEN:
            continue
        if hasattr(each, "keys"):
            yield from _members(each, f"{path}/{name}".strip("/"), kind)
            continue
        units = next((plain_text(each.attrs[key]) for key in UNITS if key in each.attrs), "")
        values = each[()]
        if kind == "MATLAB 7.3" and plain_text(each.attrs.get("MATLAB_class", "")) == "char":
            values = "".join(map(chr, np.ravel(values)))
        if getattr(values, "dtype", None) is not None and values.dtype.kind == "O":
            values = np.asarray([plain_text(x) for x in np.ravel(values)][:1], dtype=str)
        yield Member(path, name, values, units)
