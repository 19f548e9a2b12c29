"""Cached arrays by name in a file of our own, which can be computed again.

A checksum stands behind the arrays. Those of the archive do not protect the shapes of its arrays:
of one that seems shorter only a part is read, and no checksum of the whole is compared.
"""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from stiction.errors import ResultError
from stiction.storage.checksums import with_checksum, without_checksum
from stiction.storage.files import prepare_folder, whole


def write_arrays(path: Path | None, **arrays: np.ndarray) -> None:
    """Write arrays, whole or not at all; the folder is made where there is none.

    Without a path they are not stored, as `read_arrays` returns none.
    In the user's cache, which nobody named, only if possible: what is not there is computed again.

    Raises
    ------
    ResultError
        If they cannot be written to another folder.
    """
    if path is None:
        return
    made = BytesIO()
    np.savez(made, allow_pickle=False, **arrays)
    try:
        prepare_folder(path.parent)
        with whole(path) as part:
            part.write_bytes(with_checksum(made.getvalue()))
    except ResultError:
        if not path.is_relative_to(cache_folder()):
            raise


def cache_folder() -> Path:
    """Return the folder of libraries in the user's cache."""
    from platformdirs import user_cache_path

    return user_cache_path("stiction") / "libraries"


def read_arrays(path: Path | None) -> dict[str, np.ndarray] | None:
    """Return the arrays of a file; None where there is none, or it is damaged."""
    if path is None or not path.is_file():
        return None
    try:
        content = without_checksum(path.read_bytes())
        if content is None:
            return None
        with np.load(BytesIO(content), allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except (OSError, ValueError, KeyError, EOFError, BadZipFile):
        return None
