"""Files and folders that are written whole or not at all, and that a power cut does not take.

What is new is made in a workshop, a hidden folder beside its place. It takes its name when the
disk has all of it. A process that is killed leaves its workshop: the next one takes it away.
"""

from __future__ import annotations

import errno
import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

from stiction.errors import ResultError

try:
    import fcntl
except ImportError:  # Windows: no process can tell whether another one is alive
    fcntl = None  # type: ignore[assignment]

WORKSHOP = ".stiction-"  # how the names of workshops begin
AT_ONCE = 32  # files synced side by side: the disk takes hardly longer for them than for one
UNSYNCABLE = (errno.EINVAL, errno.ENOTSUP)  # what some file systems say of a folder


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
    """Yield a path to write to, which takes the place of `target` when all is written.

    Raises
    ------
    ResultError
        If it cannot be written there.
    """
    try:
        with workshop(target.parent) as room:
            part = room / f"part{target.suffix}"
            yield part
            place({part: target})
    except OSError as error:
        raise ResultError(f"{target}: cannot be written: {error.strerror or error}") from None


def place(made: Mapping[Path, Path]) -> None:
    """Give files and folders of a workshop their names: the disk has first the one, then the other.

    Parameters
    ----------
    made : mapping of Path to Path
        What was made, and the path that it takes; a file that is there is replaced.
    """
    sync(each for part in made for each in (part, *(part.rglob("*") if part.is_dir() else ())))
    changed = {target.parent for target in made.values()}
    for part, target in made.items():
        changed |= {folder.parent for folder in make_folders(target.parent)}
        part.replace(target)
    sync(changed)


def make_folders(folder: Path) -> list[Path]:
    """Make a folder, and those that it lies in; return the ones that were not there."""
    new = [each for each in (folder, *folder.parents) if not each.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    return new


def sync(paths: Iterable[Path]) -> None:
    """Wait until the disk has the content of files, and the names in folders."""
    for _ in _pool(os.getpid()).map(_sync, paths):
        pass


@cache
def _pool(_: int) -> ThreadPoolExecutor:
    """Return the threads of a process that sync its files; a fork has none of its parent's."""
    return ThreadPoolExecutor(AT_ONCE)


def _sync(path: Path) -> None:
    folder = path.is_dir()
    if folder and os.name == "nt":  # it cannot be opened there
        return
    handle = os.open(path, os.O_RDWR if os.name == "nt" else os.O_RDONLY)
    try:
        os.fsync(handle)
    except OSError as error:
        if not folder or error.errno not in UNSYNCABLE:
            raise
    finally:
        os.close(handle)


@contextmanager
def workshop(folder: Path) -> Iterator[Path]:
    """Yield a hidden folder inside `folder` to make something in; it is gone afterwards.

    Those of processes that were killed are taken away first.
    """
    for left in folder.glob(f"{WORKSHOP}*"):
        with held(left, alone=True) as mine:
            if mine:
                shutil.rmtree(left, ignore_errors=True)
    while True:
        room = Path(tempfile.mkdtemp(dir=folder, prefix=WORKSHOP))
        with held(room):
            if not room.exists():  # another process took it for one that was left
                continue
            try:
                yield room
            finally:
                shutil.rmtree(room, ignore_errors=True)
            return


@contextmanager
def held(folder: Path, *, alone: bool = False) -> Iterator[bool]:
    """Hold a folder, together with others or alone; yield whether it could be held.

    What others hold is not waited for. The system lets go of a folder when the process ends,
    however it does. Where folders cannot be held, as on Windows, nobody holds one alone.
    """
    handle = None
    with suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
    try:
        yield handle is not None and _lock(handle, alone)
    finally:
        if handle is not None:
            os.close(handle)


def _lock(handle: int, alone: bool) -> bool:
    if fcntl is None:
        return not alone
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB if alone else fcntl.LOCK_SH)
    except OSError:
        return False
    return True
