"""Arrays by name in a file of our own: what can be computed again, kept for the next time."""

from __future__ import annotations

from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from stiction.storage.files import make_folders, whole


def write_arrays(path: Path, **arrays: np.ndarray) -> None:
    """Write arrays, whole or not at all; the folder is made where there is none."""
    make_folders(path.parent)
    with whole(path) as part, part.open("wb") as opened:
        np.savez(opened, allow_pickle=False, **arrays)


def read_arrays(path: Path | None) -> dict[str, np.ndarray] | None:
    """Return the arrays of a file; None where there is none, or it is damaged."""
    if path is None or not path.is_file():
        return None
    try:
        with path.open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except (OSError, ValueError, KeyError, EOFError, BadZipFile):
        return None
