"""The seal of a store: checksums of all initial files, in its own attributes.

Zarr has no checksums for names, units, the description, and the metadata of arrays. The values
have their own, chunk by chunk.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any

from stiction.errors import ResultError
from stiction.result.file import repair_of
from stiction.storage import checksums

ROOT, SEAL, DESCRIPTION = "zarr.json", "checksums", "description"
ANEW = (
    "its description is damaged too, so it cannot be repaired: run the study anew in another store"
)


def seal(folder: Path) -> None:
    """Seal a new store."""
    parts = {str(each.relative_to(folder).as_posix()): each for each in sorted(folder.rglob("*"))}
    files = {name: each.read_bytes() for name, each in parts.items() if each.is_file()}
    root = json.loads(files[ROOT])
    root["attributes"].pop(SEAL, None)
    files |= _own(root)
    root["attributes"][SEAL] = checksums.seal(files)
    (folder / ROOT).write_text(json.dumps(root, indent=2), encoding="utf-8")


def broken_files(folder: Path) -> list[str]:
    """Return the sealed files of a store that have changed or are missing."""
    try:
        root = json.loads((folder / ROOT).read_bytes())
        sealed = root["attributes"].pop(SEAL)
        own = _own(root)
        names = json.loads(sealed).keys() - own.keys()
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return [ROOT, DESCRIPTION]
    files = {name: folder / name for name in names}
    parts = {name: each.read_bytes() for name, each in files.items() if each.is_file()}
    return checksums.broken_parts(sealed, parts | own)


def identity(folder: Path) -> str:
    """Return a digest of a store's root metadata: equal for two stores only of the same content.

    The root has the description, and the checksums of all other initial files. It is empty where
    the root is missing.
    """
    try:
        return sha256((folder / ROOT).read_bytes()).hexdigest()
    except OSError:
        return ""


def damage(path: str | Path, files: Sequence[object]) -> ResultError:
    """Return the error for a damaged store."""
    names = ", ".join(map(str, files[:3])) + (f" and {len(files) - 3} more" * (len(files) > 3))
    again = f"compute it again with: {repair_of(path)}"
    lost = {ROOT, DESCRIPTION} <= {*map(str, files)}
    return ResultError(f"{path}: is damaged: {names}; {ANEW if lost else again}")


def _own(root: Any) -> dict[str, bytes]:
    """Return the root metadata of a store, independent of its formatting, and its description."""
    description = str(root["attributes"].get(DESCRIPTION, ""))
    return {
        ROOT: json.dumps(root, sort_keys=True).encode(),
        DESCRIPTION: description.encode(),
    }
