"""Arrays by name in a file of our own: what can be computed again, kept for the next time."""

from __future__ import annotations

from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from stiction.errors import ResultError
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
    try:
        prepare_folder(path.parent)
        with whole(path) as part, part.open("wb") as opened:
            np.savez(opened, allow_pickle=False, **arrays)
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
        with path.open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except (OSError, ValueError, KeyError, EOFError, BadZipFile):
        return None
