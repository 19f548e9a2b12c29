"""What a result file knows of itself: checksums of all that is read back from it.

Each array has HDF5's own (fletcher32), which any program heeds. It does not hold for names, for
attributes, and for what says where in the file an array is: those of all this are in an attribute.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from stiction.checksums import broken, bytes_of, seal

if TYPE_CHECKING:
    import xarray as xr

SEAL, DESCRIPTION = "checksums", "description"  # attributes of the file
CHUNK = 2**16  # samples that share a checksum


def sealed(tables: Mapping[str, xr.Dataset]) -> str:
    """Return the checksums of tables, as they are kept in the attribute."""
    return seal(_parts(tables))


def checked(table: xr.Dataset) -> dict[Any, dict[str, Any]]:
    """Return how the arrays of a table are encoded: with HDF5's checksums."""
    return {
        name: {"fletcher32": True, "chunksizes": (min(each.size, CHUNK),)}
        for name, each in table.variables.items()
        if each.size
    }


def damaged(known: str | None, tables: Mapping[str, xr.Dataset]) -> list[str]:
    """Return the names of what is not as it was written; older versions kept no checksums."""
    if known is None:
        arrays = [each for table in tables.values() for each in table.variables.values()]
        return [SEAL] if any(each.encoding.get("fletcher32") for each in arrays) else []
    return broken(known, _parts(tables))


def intact(known: str, description: str) -> bool:
    """Return whether a description is the one that was written."""
    return DESCRIPTION not in broken(known, {DESCRIPTION: description.encode()})


def _parts(tables: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    """Return all that is in tables: the numbers of each array, and every attribute together."""
    numbers: dict[str, Any] = {}
    attributes: dict[str, Any] = {}
    for name, table in tables.items():
        kept = {key: value for key, value in table.attrs.items() if key != SEAL}
        if DESCRIPTION in kept:
            numbers[DESCRIPTION] = str(kept.pop(DESCRIPTION)).encode()
        attributes[name] = _plain(kept)
        for column, each in table.variables.items():
            numbers[f"{name}.{column}"] = bytes_of(each.values)
            attributes[f"{name}.{column}"] = [each.dtype.kind, each.dims, _plain(each.attrs)]
    return {**numbers, "attributes": json.dumps(attributes, sort_keys=True).encode()}


def _plain(attributes: Mapping[Any, Any]) -> dict[str, Any]:
    """Return attributes as they are in any format: numbers, texts and lists of them."""
    plain = {str(name): np.asarray(value).tolist() for name, value in attributes.items()}
    return {
        name: value[0] if isinstance(value, list) and len(value) == 1 else value
        for name, value in plain.items()
    }
