"""The seal of a store: checksums of all that is written when it is made, in its own attributes.

Values have checksums of their own, chunk by chunk. Names, units, the description and what says
how chunks are to be read have none in zarr.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from stiction.errors import ResultError
from stiction.storage import checksums

ROOT, SEAL, DESCRIPTION = "zarr.json", "checksums", "description"
ANEW = (
    "its description is damaged, too, so nothing can be computed again: do the study anew, in "
    "another store"
)


def seal(folder: Path) -> None:
    """Seal all that is in a new store."""
    parts = {str(each.relative_to(folder).as_posix()): each for each in sorted(folder.rglob("*"))}
    files = {name: each.read_bytes() for name, each in parts.items() if each.is_file()}
    root = json.loads(files[ROOT])
    root["attributes"].pop(SEAL, None)
    files |= _own(root)
    root["attributes"][SEAL] = checksums.seal(files)
    (folder / ROOT).write_text(json.dumps(root, indent=2), encoding="utf-8")


def broken(folder: Path) -> list[str]:
    """Return the files of a store that are not what they were when it was made, or are missing."""
    try:
        root = json.loads((folder / ROOT).read_bytes())
        sealed = root["attributes"].pop(SEAL)
        own = _own(root)
        names = json.loads(sealed).keys() - own.keys()
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return [ROOT, DESCRIPTION]
    files = {name: folder / name for name in names}
    parts = {name: each.read_bytes() for name, each in files.items() if each.is_file()}
    return checksums.broken(sealed, parts | own)


def damage(path: str | Path, files: Sequence[object]) -> ResultError:
    """Return what is said of a store that is not whole."""
    names = ", ".join(map(str, files[:3])) + (f" and {len(files) - 3} more" * (len(files) > 3))
    again = f"compute it again with: stiction check {path} --repair"
    lost = {ROOT, DESCRIPTION} <= {*map(str, files)}
    return ResultError(f"{path}: is damaged: {names}; {ANEW if lost else again}")


def _own(root: Any) -> dict[str, bytes]:
    """Return what stands in the store's own file, however it is laid out, and its description."""
    description = str(root["attributes"].get(DESCRIPTION, ""))
    return {
        ROOT: json.dumps(root, sort_keys=True).encode(),
        DESCRIPTION: description.encode(),
    }
