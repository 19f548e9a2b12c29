"""Files that are written whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from stiction.errors import ResultError


def placeable(path: str | Path) -> Path:
    """Return a path, if a file can be put there, in place of what is there.

    Raises
    ------
    ResultError
        If there is no such folder, or something else than a file is there.
    """
    target = Path(path)
    if not target.parent.is_dir():
        raise ResultError(f"{target}: no folder {target.parent}; make it first")
    if target.exists() and not target.is_file():
        raise ResultError(f"{target}: is there, and is not a file; choose another name")
    return target


def usable_folder(folder: Path) -> None:
    """Refuse a folder for results that is none, or that cannot be made.

    Raises
    ------
    ResultError
        If something else is there, or there is no folder to make it in.
    """
    if folder.exists() and not folder.is_dir():
        raise ResultError(f"{folder}: is there, and is not a folder; choose another name")
    if not folder.exists() and not folder.parent.is_dir():
        raise ResultError(f"{folder}: no folder {folder.parent}; make it first")


def make_folder(folder: Path) -> Path:
    """Make a folder, if it is not there; return it.

    Raises
    ------
    ResultError
        If it cannot be made.
    """
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise ResultError(f"{folder}: cannot be made: {error.strerror or error}") from None
    return folder


@contextmanager
def whole(target: Path) -> Iterator[Path]:
    """Yield a path to write to, beside `target`, which takes its place when all is written.

    Raises
    ------
    ResultError
        If it cannot be written there.
    """
    part = None
    try:
        handle, name = tempfile.mkstemp(dir=target.parent, suffix=".part")
        os.close(handle)
        part = Path(name)
        yield part
        mask = os.umask(0)
        os.umask(mask)
        part.chmod(0o666 & ~mask)
        part.replace(target)
    except OSError as error:
        raise ResultError(f"{target}: cannot be written: {error.strerror or error}") from None
    finally:
        if part is not None:
            part.unlink(missing_ok=True)
