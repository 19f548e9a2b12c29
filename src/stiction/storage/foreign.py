"""Checks of a foreign file before it is opened: links, other files, damage and size."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from pathlib import Path
from typing import Any

from stiction.errors import ResultError, StictionError, one_line
from stiction.machine import shortage

UNREADABLE = "not a NetCDF file that can be read"


@contextmanager
def opening(path: str | Path, what: str) -> Iterator[None]:
    """Turn whatever a library raises on a damaged or wrong file into a `ResultError`.

    Raises
    ------
    ResultError
        With `what` is wrong with the file.
    TypeError
        If `path` is not a path, which is not damage; `stiction.arguments` names the argument.
    """
    os.fspath(path)
    try:
        yield
    except StictionError:
        raise
    except Exception as error:
        raise ResultError(f"{path}: {what}: {one_line(error)}") from None


def is_within(folder: str | Path, path: str | Path) -> bool:
    """Return whether a path leads into a folder, links resolved."""
    return Path(os.path.realpath(path)).is_relative_to(os.path.realpath(folder))


def refuse_links(folder: str | Path) -> None:
    """Refuse a store that contains links, which redirect reading and writing.

    Raises
    ------
    ResultError
        Naming the first link.
    """
    for link in _links(folder):
        raise ResultError(
            f"{folder}: contains a link, {os.path.relpath(link, folder)}, which leads elsewhere; "
            "put the file itself in its place"
        )


def _links(folder: str | Path) -> Iterator[str]:
    with suppress(FileNotFoundError), os.scandir(folder) as entries:  # others may delete files
        for entry in entries:
            if entry.is_symlink():
                yield entry.path
            elif entry.is_dir(follow_symlinks=False):
                yield from _links(entry.path)


def refuse_other_files(path: str | Path) -> None:
    """Refuse an HDF5 file that refers to other files, or names one object twice.

    Raises
    ------
    ResultError
        Naming the first link, external or virtual dataset in it.
    OSError
        If it is not an HDF5 file.
    """
    h5py: Any = import_module("h5py")  # slow to import
    sizes: list[float] = []
    with h5py.File(path) as file:

        def look(name: str, link: object) -> str | None:
            if not isinstance(link, h5py.HardLink):
                return f"{name} is a link"
            member = file.get(name)
            if isinstance(member, h5py.Dataset) and (member.external or member.is_virtual):
                return f"{name} has its numbers in another file"
            if isinstance(member, h5py.Dataset):
                sizes.append(float(member.size or 0) * member.dtype.itemsize)
            return None

        found = file.visititems_links(look)
    if found is not None:
        raise ResultError(f"{path}: {found}, which a result never contains; it was not read")
    refuse_size(path, sum(sizes))


def read_through(path: str | Path) -> None:
    """Read everything in an HDF5 file.

    Raises
    ------
    ResultError
        If it cannot be read, or contains what `refuse_other_files` refuses.
    """
    h5py: Any = import_module("h5py")

    def read(name: str, each: Any) -> None:
        dict(each.attrs)
        if isinstance(each, h5py.Dataset):
            each[()]

    with opening(path, UNREADABLE):
        refuse_other_files(path)
        with h5py.File(path) as file:
            read("/", file)
            file.visititems(read)


def refuse_size(path: str | Path, size: float) -> None:
    """Refuse to read `size` bytes of a file that do not fit into memory.

    Raises
    ------
    ResultError
        If they exceed the limit on this machine.
    """
    if short := shortage(size):
        raise ResultError(f"{path}: reading it {short}; read a part of it with xarray")
