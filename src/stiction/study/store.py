"""A study on disk: one zarr array a measure, written block by block, its status last.

The status of a run is -1 until it is known. That of a block is one file, written whole after
all else of that block: it is the mark that the block is done.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple
from uuid import uuid4

import numpy as np

from stiction import errors
from stiction.errors import ResultError, one_line
from stiction.foreign import refuse_links
from stiction.study.kept import Kept
from stiction.study.layout import Index, Layout, Region
from stiction.study.measures import FORMERLY
from stiction.study.plan import Study

if TYPE_CHECKING:
    from collections.abc import Iterator

    import xarray as xr
    import zarr

FORMAT = 1  # of the store
PENDING = -1
# how a run can end: as every run, or refused before it began, or by an error of the program
ENDS = (*(status.name.lower() for status in errors.Status), "refused", "error")
COMPLETED, REFUSED, ERROR = 0, ENDS.index("refused"), ENDS.index("error")


class Block(NamedTuple):
    """What a region's runs came to: arrays of the region's shape, and of each value's own."""

    values: Sequence[tuple[Kept, np.ndarray]]
    status: np.ndarray
    message: np.ndarray


class Store(NamedTuple):
    """A study's store, open for reading and writing.

    Parameters
    ----------
    path : Path
        The folder.
    group : zarr.Group
        What is in it.
    layout : Layout
        Of its runs, with the blocks in which it is written.
    """

    path: Path
    group: zarr.Group
    layout: Layout

    def status(store) -> np.ndarray:
        """Return the status of every run."""
        return np.asarray(store._array("status")[...])

    def has(store, region: Region) -> bool:
        """Return whether a block is done: its status is written, last and whole."""
        return store._file("status", region, 0).is_file()

    def message(store, index: Index) -> str:
        """Return why a run failed."""
        return str(store._array("message")[index])

    def write(store, region: Region, block: Block) -> None:
        """Write a block, its status last."""
        with told(store.path):
            for each, values in block.values:
                store._write(each.name, region, values, each.unknown)
            if block.message.any():
                store._array("message")[region] = block.message
            store._write("status", region, block.status, PENDING)

    def _write(store, name: str, region: Region, values: np.ndarray, fill: float) -> None:
        """Write a whole chunk, as the specification of zarr has it: bytes in a file of their own.

        Through zarr it takes the processor eight times as long, as long as a sixth of a run.
        """
        block, own = store.layout.block, values.shape[len(region) :]
        chunk = np.full((*block, *own), fill, values.dtype.newbyteorder("<"))  # whole at the edges
        chunk[tuple(slice(0, n) for n in values.shape)] = values
        file = store._file(name, region, len(own))
        file.parent.mkdir(parents=True, exist_ok=True)
        part = file.with_name(f".{uuid4().hex}.part")
        try:
            part.write_bytes(chunk.tobytes())
            part.replace(file)
        except OSError:
            part.unlink(missing_ok=True)
            raise

    def _file(store, name: str, region: Region, own: int) -> Path:
        """Return where the chunk of a region is; its `own` dimensions are not cut."""
        pairs = zip(region, store.layout.block, strict=True)
        places = (str(part.start // b) for part, b in pairs)
        return store.path.joinpath(name, "c", *places, *["0"] * own)

    def _array(store, name: str) -> Any:
        return store.group[name]

    def __reduce__(store) -> tuple[Any, ...]:
        """Pickle by the path: another process opens it for itself."""
        return _reopened, (str(store.path.absolute()), store.layout)


@lru_cache(maxsize=4)
def _reopened(path: str, layout: Layout) -> Store:
    return Store(Path(path), group_at(path, "r+"), layout)


@contextmanager
def told(path: Path) -> Iterator[None]:
    """Turn what the file system refuses into a message."""
    try:
        yield
    except OSError as error:
        raise ResultError(
            f"{path}: cannot be written: {error.strerror or error}; what is in it is whole: "
            "make room, then give the same command again"
        ) from None


def opened(study: Study, path: str | Path) -> Store:
    """Open the store of a study that has begun.

    Raises
    ------
    ResultError
        If there is something else.
    """
    group = group_at(path, "r+")
    held = group.attrs.get("description")
    if held != study.to_json():
        raise ResultError(
            f"{path}: holds another study, or one that was described differently; nothing is "
            "written over it: choose another name, or take it away"
        )
    if group.attrs.get("stiction_version") != version():
        raise ResultError(
            f"{path}: was begun by stiction {group.attrs.get('stiction_version')}, this is "
            f"{version()}; go on with that one, or choose another name"
        )
    layout = study.layout
    chunks: Any = group["status"]
    return Store(Path(path), group, layout._replace(block=tuple(chunks.chunks)))


def group_at(path: str | Path, mode: Literal["r", "r+"]) -> zarr.Group:
    """Return what is in the store of a study.

    Raises
    ------
    ResultError
        If it is none.
    """
    import zarr

    if not os.path.isdir(path):
        raise ResultError(f"{path}: no such store; write one with 'stiction sweep'")
    refuse_links(path)
    try:  # of format 2 of zarr, pickles were a part
        group = zarr.open_group(Path(path), mode=mode, zarr_format=3, use_consolidated=False)
        known = group.attrs.get("format")
    except Exception as error:  # whatever zarr raises of what is none
        raise ResultError(f"{path}: is not the store of a study: {one_line(error)}") from None
    if known != FORMAT:
        by = f"stiction {group.attrs.get('stiction_version')!s:.20} wrote it, this is {version()}"
        what = "is not the store of a study" if known is None else f"has format {known!s:.20}; {by}"
        raise ResultError(f"{path}: {what}; choose another name")
    return group


def open_study(path: str | Path) -> xr.Dataset:
    """Return a study's store, its values read when they are asked for.

    It is ``xarray.open_zarr(path)`` after a look at whether it is one; measures of older stores
    have the names that they have now.

    Raises
    ------
    ResultError
        If it is none.
    """
    import xarray as xr

    group_at(path, "r")
    data: xr.Dataset = xr.open_zarr(path, zarr_format=3)
    return data.rename({old: new for old, new in FORMERLY.items() if old in data})


def version() -> str:
    """Return the version of this package."""
    from stiction import __version__

    return __version__
