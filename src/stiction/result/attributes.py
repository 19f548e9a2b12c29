"""Reading of a file's attributes in another process, with few imports (`apart`)."""

from __future__ import annotations

from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any

from stiction.errors import ResultError
from stiction.storage.checksums import broken_parts, bytes_of
from stiction.storage.foreign import opening

SEAL, DESCRIPTION = "checksums", "description"
TIMES = "samples.time"  # what checksums call the times of the samples


def list_attributes(path: str) -> str:
    """Return the names of the attributes of an HDF5 file, a line each."""
    h5py: Any = import_module("h5py")  # slow to import
    with h5py.File(path) as file:
        return "\n".join(map(str, file.attrs))


def intact_description(path: str | Path) -> tuple[str, str]:
    """Return the description from a result file whose other parts are damaged, and its checksums.

    Raises
    ------
    ResultError
        If the description is damaged too, or has no checksum.
    """
    h5py: Any = import_module("h5py")  # slow to import
    lost = "too damaged to be repaired: its description cannot be read; run it again"
    with opening(path, lost), h5py.File(path) as file:
        if not {SEAL, DESCRIPTION} <= set(file.attrs):
            raise ResultError(f"{path}: {lost}")
        known, text = str(file.attrs[SEAL]), str(file.attrs[DESCRIPTION])
        whole = DESCRIPTION not in broken_parts(known, {DESCRIPTION: text.encode()})
    if not whole:
        raise ResultError(f"{path}: is damaged, and so is its description; run it again")
    return text, known


def legible_attributes(path: str | Path) -> dict[str, Any]:
    """Return the texts and numbers among the attributes of a damaged result file."""
    h5py: Any = import_module("h5py")  # slow to import
    found: dict[str, Any] = {}
    with suppress(OSError, RuntimeError, KeyError), h5py.File(path) as file:
        for name in file.attrs:
            with suppress(Exception):  # h5py raises anything where an attribute is damaged
                value = file.attrs[name]
                found[str(name)] = value if isinstance(value, str) else value.item()
    return {name: value for name, value in found.items() if isinstance(value, str | int | float)}


def intact_times(path: str | Path) -> list[float]:
    """Return the times of the samples from a result file whose other parts are damaged, s.

    Raises
    ------
    ResultError
        If they are damaged too.
    """
    h5py: Any = import_module("h5py")  # slow to import
    lost = "is damaged, and so are its times, which its description does not hold; run it again"
    with opening(path, lost), h5py.File(path) as file:
        times = file["time"][()]
        if TIMES in broken_parts(str(file.attrs[SEAL]), {TIMES: bytes_of(times)}):
            raise ResultError(f"{path}: {lost}")
    return [*times.tolist()]
