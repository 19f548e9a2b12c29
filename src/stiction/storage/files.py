"""Files and folders that are written whole or not at all, and that survive a power cut.

New files are made in a workshop, a hidden folder beside their destination, and are renamed once
the disk has all of them. A killed process leaves its workshop behind; the next one removes it.
"""

from __future__ import annotations

import errno
import os
import shutil
import tempfile
from collections.abc import Collection, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

from stiction.errors import ResultError, echo

try:
    import fcntl
except ImportError:  # Windows: a process cannot lock a folder
    fcntl = None  # type: ignore[assignment]

WORKSHOP = ".stiction-"  # prefix of a workshop's name
AT_ONCE = 32  # files synced at a time: this takes a disk hardly longer than one file
NETCDF = (".nc",)  # suffix of results and of records
FORBIDDEN = (errno.EACCES, errno.EPERM, errno.EROFS)  # errors of folders that are not the user's
FULL = (errno.ENOSPC, errno.EDQUOT)
ELSEWHERE = "choose another folder"  # remedy of the former
UNSYNCABLE = (errno.EINVAL, errno.ENOTSUP)  # errors of file systems that cannot sync a folder


def placeable(path: str | Path, suffixes: Collection[str] = ()) -> Path:
    """Return a path, if a file can be written there or replaced.

    Parameters
    ----------
    path : str or Path
        The file.
    suffixes : collection of str, optional
        Those that its name may have; any by default.

    Raises
    ------
    ResultError
        If it is not a path, its name has another suffix, its folder does not exist or cannot be
        written to, or something other than a file is there.
    """
    if not isinstance(path, str | os.PathLike):
        raise ResultError(f"a file is named by text or a path, not by {echo(path)}")
    target = Path(path)
    if target.name in ("", ".."):
        raise ResultError(f"{target}: is a folder; name a file in it")
    if suffixes and target.suffix.lower() not in suffixes:
        first, *others = suffixes
        remedy = f"name it {target.stem}{first}"
        if others:
            remedy = f"use {', '.join(suffixes)}, such as {target.stem}{first}"
        raise ResultError(f"{target}: unknown format {echo(target.suffix)}; {remedy}")
    if not target.parent.is_dir():
        raise ResultError(f"{target}: folder {target.parent} does not exist; make it first")
    if target.exists() and not target.is_file():
        raise ResultError(f"{target}: exists and is not a file; choose another name")
    _refuse_unwritable(target, target.parent)
    return target


def usable_folder(folder: Path) -> None:
    """Refuse a path that is not a folder and cannot become one.

    Raises
    ------
    ResultError
        If something else is there, its parent folder does not exist, or neither can be written to.
    """
    if folder.exists() and not folder.is_dir():
        raise ResultError(f"{folder}: exists and is not a folder; choose another name")
    if not folder.exists() and not folder.parent.is_dir():
        raise ResultError(f"{folder}: folder {folder.parent} does not exist; make it first")
    _refuse_unwritable(folder, folder if folder.exists() else folder.parent)


def without_compression(path: Path) -> Path:
    """Return a path without the suffix of its compression.

    >>> without_compression(Path("data.csv.gz")).name, without_compression(Path("data.csv")).name
    ('data.csv', 'data.csv')
    """
    return path.with_suffix("") if path.suffix.lower() == ".gz" else path


def folder_or_file(path: Path, suffixes: Collection[str]) -> Path:
    """Return a path to which either a folder or a file with one of some suffixes can be written.

    A folder with a suffix has to exist, so that a format that is not written makes no folder.

    Raises
    ------
    ResultError
        As of `placeable` or `usable_folder`; also if the name has another suffix.
    """
    suffix = path.suffix.lower()
    if suffix in suffixes:
        return placeable(path, suffixes)
    if suffix[1:2].isalpha() and not path.is_dir():
        named = " or ".join(f"{path.stem}{each}" for each in suffixes)
        raise ResultError(
            f"{path}: unknown format {echo(path.suffix)}; name a folder, such as {path.stem}, or "
            f"write {named}"
        )
    usable_folder(path)
    return path


def _refuse_unwritable(target: Path, folder: Path) -> None:
    if not os.access(folder, os.W_OK | os.X_OK):
        raise ResultError(
            f"{target}: cannot be written: folder {folder} may not be written to; {ELSEWHERE}"
        )


def reason(error: OSError) -> str:
    """Return why something cannot be written, and the remedy.

    Examples
    --------
    >>> reason(OSError(errno.EROFS, "Read-only file system"))
    'Read-only file system; choose another folder'
    >>> reason(OSError(errno.ENOSPC, "No space left on device"))
    'No space left on device; make room'
    """
    remedy = {**dict.fromkeys(FORBIDDEN, ELSEWHERE), **dict.fromkeys(FULL, "make room")}
    known = remedy.get(error.errno or 0, "")
    return f"{error.strerror or error}{known and f'; {known}'}"


def make_folder(folder: Path) -> Path:
    """Make a folder unless it exists; return it.

    Raises
    ------
    ResultError
        If it cannot be made.
    """
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise ResultError(f"{folder}: cannot be made: {reason(error)}") from None
    return folder


def prepare_folder(folder: Path) -> Path:
    """Make a folder and its missing parents, into which files will be written; return it.

    Raises
    ------
    ResultError
        If it cannot be made, or be written to.
    """
    try:
        make_folders(folder)
    except OSError as error:
        raise ResultError(f"{folder}: cannot be made: {reason(error)}") from None
    _refuse_unwritable(folder, folder)
    return folder


@contextmanager
def whole(target: Path) -> Iterator[Path]:
    """Yield a temporary path, which replaces `target` once it is written completely.

    Raises
    ------
    ResultError
        If `target` cannot be written.
    """
    try:
        with workshop(target.parent) as room:
            part = room / f"part{target.suffix}"
            yield part
            place({part: target})
    except OSError as error:
        raise ResultError(f"{target}: cannot be written: {reason(error)}") from None


def write_text(text: str, path: str | Path, suffixes: Collection[str] = ()) -> Path:
    """Write a text into a file, whole or not at all; return its path.

    `suffixes` are as for `placeable`.

    Raises
    ------
    ResultError
        If it cannot be written there.
    """
    target = placeable(path, suffixes)
    with whole(target) as part:
        part.write_text(text, encoding="utf-8")
    return target


def place(made: Mapping[Path, Path]) -> None:
    """Move files and folders out of a workshop, each after its content is on the disk.

    Parameters
    ----------
    made : mapping of Path to Path
        From each path in the workshop to its destination; existing files are replaced.
    """
    sync(each for part in made for each in (part, *(part.rglob("*") if part.is_dir() else ())))
    changed = {target.parent for target in made.values()}
    for part, target in made.items():
        changed |= {folder.parent for folder in make_folders(target.parent)}
        part.replace(target)
    sync(changed)


def make_folders(folder: Path) -> list[Path]:
    """Make a folder and its missing parents; return those that were made."""
    new = [each for each in (folder, *folder.parents) if not each.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    return new


def sync(paths: Iterable[Path]) -> None:
    """Wait until the content of files and the entries of folders are on the disk."""
    for _ in _pool(os.getpid()).map(_sync, paths):
        pass


@cache
def _pool(_: int) -> ThreadPoolExecutor:
    """Return this process's threads for syncing; a fork does not inherit its parent's."""
    return ThreadPoolExecutor(AT_ONCE)


def _sync(path: Path) -> None:
    folder = path.is_dir()
    if folder and os.name == "nt":  # Windows cannot open a folder
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
    """Yield a hidden folder inside `folder` for work in progress; remove it afterwards.

    Workshops of killed processes are removed first.
    """
    for left in folder.glob(f"{WORKSHOP}*"):
        with folder_lock(left, alone=True) as mine:
            if mine:
                shutil.rmtree(left, ignore_errors=True)
    while True:
        room = Path(tempfile.mkdtemp(dir=folder, prefix=WORKSHOP))
        with folder_lock(room):
            if not room.exists():  # another process took it for an abandoned one
                continue
            try:
                yield room
            finally:
                shutil.rmtree(room, ignore_errors=True)
            return


@contextmanager
def folder_lock(folder: Path, *, alone: bool = False) -> Iterator[bool]:
    """Lock a folder, shared or `alone`; yield whether this succeeded.

    It does not wait for others. The system releases the lock when the process ends, however it
    ends. Where folders cannot be locked, as on Windows, an exclusive lock never succeeds.
    """
    handle = None
    with suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
    try:
        yield handle is not None and _lock(handle, alone)
    finally:
        if handle is not None:
            os.close(handle)


@contextmanager
def claim(path: Path) -> Iterator[bool]:
    """Claim a piece of work by a locked file, removed afterwards; yield whether nobody else has it.

    The system releases the lock of a process that ends, however it ends. Where files cannot be
    locked or made, every claim succeeds.
    """
    handle, mine = _claim(path)
    try:
        yield mine
    finally:
        if handle is not None:
            with suppress(OSError):
                path.unlink()  # as long as it is locked
            os.close(handle)


def _claim(path: Path) -> tuple[int | None, bool]:
    """Return the handle of a claim's locked file, or None; and whether the claim succeeds."""
    while fcntl is not None:
        try:
            handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        except OSError:
            break
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if os.fstat(handle).st_ino == path.stat().st_ino:
                return handle, True
        except BlockingIOError:
            os.close(handle)
            return None, False
        except FileNotFoundError:
            pass
        except OSError:
            return handle, True
        os.close(handle)  # another process had it, and has removed it since
    return None, True


def _lock(handle: int, alone: bool) -> bool:
    if fcntl is None:
        return not alone
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB if alone else fcntl.LOCK_SH)
    except OSError:
        return False
    return True
