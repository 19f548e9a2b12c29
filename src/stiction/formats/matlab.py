"""MATLAB files of versions 5 to 7."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from stiction.formats import TextLayout
from stiction.formats.members import Member, tables_of
from stiction.formats.table import FileTable
from stiction.storage.foreign import refuse_size

DEEPEST = 6  # structs inside one another
UNITS = ("units", "unit", "Units")


def read(path: Path, layout: TextLayout) -> list[FileTable]:
    """Return the tables of a MATLAB file: vectors, matrices, and structs of these."""
    io: Any = import_module("scipy.io")  # slow to import
    kinds = io.whosmat(path)
    refuse_size(path, 24.0 * sum(float(np.prod(shape, dtype=float)) for _, shape, _ in kinds))
    content = io.loadmat(path, simplify_cells=True)
    found = {name: each for name, each in content.items() if not name.startswith("__")}
    return tables_of(members_of(found), "MATLAB")


def members_of(content: Mapping[str, Any], group: str = "", depth: int = 0) -> Iterator[Member]:
    """Yield the arrays of structs; a struct ``units`` beside or above gives their units."""
    units: Any = next((content[name] for name in UNITS if name in content), {})
    for name, each in content.items():
        if name in UNITS and isinstance(each, Mapping):
            continue
        if isinstance(each, Mapping):
            inner = dict(each)
            its = units.get(name) if isinstance(units, Mapping) else None
            if isinstance(its, Mapping) and not set(UNITS) & set(inner):
                inner["units"] = its
            if depth < DEEPEST:
                yield from members_of(inner, f"{group}/{name}".strip("/"), depth + 1)
            continue
        unit = units.get(name, "") if isinstance(units, Mapping) else ""
        yield Member(group, name, each, str(unit))
