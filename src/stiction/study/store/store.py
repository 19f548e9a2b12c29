"""A study on disk: one zarr array a measure, written block by block, its status last.

The status of a run is -1 until it is known. That of a block is one file, written when the disk has
all else of that block: it is the mark that the block is done. Each chunk has a checksum, and so has
what is written when the store is made. In stores of format 1 nothing has.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import lru_cache
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from stiction import errors
from stiction.errors import ResultError
from stiction.storage.checksums import LENGTH, with_checksum, without_checksum
from stiction.storage.files import place, workshop
from stiction.storage.foreign import opening, refuse_links, refuse_size
from stiction.study.plan.layout import MANY_TASKS, Index, Layout, Region
from stiction.study.plan.study import Study
from stiction.study.store import seal
from stiction.study.store.kept import Kept, names_kept
from stiction.study.variables.measures import FORMERLY

if TYPE_CHECKING:
    import xarray as xr
    import zarr

FORMATS = (1, 2)  # of stores that can be read
CHECKED = 2  # from this one on all has checksums; it is the one that is written
PENDING = -1
MOST_TASKS = 256 * MANY_TASKS  # each is looked at: what a store says of itself is bounded
# how a run can end: as every run, or refused before it began, or by an error of the program
ENDS = (*(status.name.lower() for status in errors.Status), "refused", "error")
COMPLETED, REFUSED, ERROR = 0, ENDS.index("refused"), ENDS.index("error")
STATUS, MESSAGE = "status", "message"


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
    chunks : mapping of str to tuple of int
        Of each array with a number for each run: the shape of its chunks, one for each block.
    """

    path: Path
    group: zarr.Group
    layout: Layout
    chunks: Mapping[str, Index]

    @property
    def checked(store) -> bool:
        """Whether chunks have checksums."""
        return bool(store.group.attrs["format"] == CHECKED)

    def status(store) -> np.ndarray:
        """Return the status of every run."""
        return np.asarray(store._array(STATUS)[...])

    def has(store, region: Region) -> bool:
        """Return whether a block is done: it is marked so, and nothing of it is missing or cut."""
        return store.mark(region).is_file() and not store.damaged(region)

    def mark(store, region: Region) -> Path:
        """Return the file that marks a block as done: that of its status."""
        return store._file(STATUS, region)

    def damaged(store, region: Region, *, read: bool = False) -> list[Path]:
        """Return the files of a block that are not whole, if it is marked as done.

        They are missing or have another length; where all is `read`, or another checksum.
        """
        mark = store.mark(region)
        if not mark.exists():
            return []
        status = store._content(mark, store._size(STATUS))
        if status is None:
            return [mark]
        sizes = {store._file(name, region): store._size(name) for name in store.chunks}
        found = [file for file, size in sizes.items() if not store._sound(file, size, read)]
        if (np.frombuffer(status, np.int8) > COMPLETED).any():  # then it says why
            file = store._file(MESSAGE, region)
            found += [file] if store._content(file) is None else []
        return found

    def _size(store, name: str) -> int:
        """Return how many bytes a chunk has on disk."""
        numbers = prod(store.chunks[name]) * store._array(name).dtype.itemsize
        return int(numbers) + (LENGTH if store.checked else 0)

    def _sound(store, file: Path, size: int, read: bool) -> bool:
        if read:
            return store._content(file, size) is not None
        return file.is_file() and file.stat().st_size == size

    def _content(store, file: Path, size: int | None = None) -> bytes | None:
        """Return what is in a chunk, without its checksum; None if it is not whole."""
        if not file.is_file():
            return None
        content = file.read_bytes()
        if size not in (None, len(content)) or not content:
            return None
        return without_checksum(content) if store.checked else content

    def message(store, index: Index) -> str:
        """Return why a run failed."""
        return str(store._array(MESSAGE)[index])

    def write(store, region: Region, block: Block) -> None:
        """Write a block, and when the disk has it the mark that it is done."""
        files = {
            store._file(each.name, region): store._whole(values, each.unknown).tobytes()
            for each, values in block.values
        }
        if block.message.any():
            files[store._file(MESSAGE, region)] = encoded(store._whole(block.message, ""))
        with told(store.path):
            store._place(files)
            store._place({store.mark(region): store._whole(block.status, PENDING).tobytes()})

    def _place(store, files: Mapping[Path, bytes]) -> None:
        """Write chunks, as the specification of zarr has them: bytes in files of their own.

        Through zarr it takes the processor eight times as long, as long as a sixth of a run.
        """
        with workshop(store.path / STATUS) as room:
            made = {}
            for number, (file, content) in enumerate(files.items()):
                part = room / str(number)
                part.write_bytes(with_checksum(content) if store.checked else content)
                made[part] = file
            place(made)

    def _whole(store, values: np.ndarray, fill: Any) -> np.ndarray:
        """Return a block's values in a whole chunk, which reaches beyond the runs at the edges."""
        own = values.shape[len(store.layout.block) :]
        chunk = np.full((*store.layout.block, *own), fill, values.dtype.newbyteorder("<"))
        chunk[tuple(slice(0, n) for n in values.shape)] = values
        return chunk

    def _file(store, name: str, region: Region) -> Path:
        """Return where the chunk of a region is; dimensions of a run's own are not cut."""
        pairs = zip(region, store.layout.block, strict=True)
        places = (str(part.start // b) for part, b in pairs)
        own = len(store.chunks.get(name, region)) - len(region)
        return store.path.joinpath(name, "c", *places, *["0"] * own)

    def _array(store, name: str) -> Any:
        return store.group[name]

    def __reduce__(store) -> tuple[Any, ...]:
        """Pickle by the path: another process opens it for itself."""
        return _reopened, (str(store.path.absolute()),)


def encoded(texts: np.ndarray) -> bytes:
    """Return texts as zarr's codec vlen-utf8 has them: how many; length and content of each."""
    contents = [str(text).encode() for text in texts.ravel()]
    lengths = np.array([len(contents), *map(len, contents)], "<u4")
    pairs = zip(lengths[1:], contents, strict=True)
    return lengths[:1].tobytes() + b"".join(n.tobytes() + content for n, content in pairs)


@lru_cache(maxsize=4)
def _reopened(path: str) -> Store:
    return store_at(path, "r+")


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
    store = store_at(path, "r+")
    attributes = store.group.attrs
    held = attributes.get("description")
    if held != study.to_json():
        raise ResultError(
            f"{path}: holds another study, or one that was described differently; nothing is "
            "written over it: choose another name, or take it away"
        )
    if attributes.get("stiction_version") != version():
        raise ResultError(
            f"{path}: was begun by stiction {attributes.get('stiction_version')}, this is "
            f"{version()}; go on with that one, or choose another name"
        )
    return store


def store_at(path: str | Path, mode: Literal["r", "r+"]) -> Store:
    """Open a store as it describes itself.

    Raises
    ------
    ResultError
        If it is none, or what was written when it was made is damaged.
    """
    group = group_at(path, mode)
    lost = seal.broken(Path(path)) if group.attrs["format"] == CHECKED else []
    try:
        study = json.loads(str(group.attrs["description"]))["study"]
        status: Any = group[STATUS]
        layout = Layout(tuple(status.metadata.dimension_names), status.shape, status.chunks)
        arrays: dict[str, Any] = {name: group[name] for name in (*names_kept(study), STATUS)}
    except (KeyError, ValueError, TypeError, AttributeError) as error:
        raise seal.damage(path, lost or [f"it lacks {error}"]) from None
    if lost:
        raise seal.damage(path, lost)
    if layout.tasks > MOST_TASKS:
        raise ResultError(f"{path}: is damaged: no study has {layout.tasks:,} blocks of runs")
    return Store(Path(path), group, layout, {name: each.chunks for name, each in arrays.items()})


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
    was = (Path(path) / STATUS / seal.ROOT).is_file()
    what = f"is damaged: {seal.ROOT}; {seal.ANEW}" if was else "is not the store of a study"
    with opening(path, what):  # of zarr's format 2 pickles are a part
        group = zarr.open_group(Path(path), mode=mode, zarr_format=3, use_consolidated=False)
        known = group.attrs.get("format")
    if known not in FORMATS:
        by = f"stiction {group.attrs.get('stiction_version')!s:.20} wrote it, this is {version()}"
        what = "is not the store of a study" if known is None else f"has format {known!s:.20}; {by}"
        raise ResultError(f"{path}: {what}; choose another name")
    return group


def open_study(path: str | Path) -> xr.Dataset:
    """Return a study's store, its values read when they are asked for.

    It is ``xarray.open_zarr(path)`` after a look at whether it is one and nothing of it is missing;
    measures of older stores have the names that they have now.

    Raises
    ------
    ResultError
        If it is none, or is damaged; if only values are, when they are asked for.
    """
    import xarray as xr
    from zarr.storage import LocalStore

    from stiction.study.store.chunks import WholeChunks

    store = store_at(path, "r")
    with opening(path, "is damaged"):
        found = [store.group[file.parent.name] for file in Path(path).glob("*/zarr.json")]
    arrays: list[Any] = [each for each in found if hasattr(each, "nbytes")]
    refuse_size(path, sum(float(each.nbytes) for each in arrays if each.ndim == 1))
    layout = store.layout
    lost = [file for task in range(layout.tasks) for file in store.damaged(layout.region(task))]
    if lost:
        raise seal.damage(path, [file.relative_to(path) for file in lost])
    files: Any = WholeChunks(LocalStore(path, read_only=True)) if store.checked else path
    with opening(path, "is damaged"):
        data: xr.Dataset = xr.open_zarr(files, zarr_format=3)
    return data.rename({old: new for old, new in FORMERLY.items() if old in data})


def version() -> str:
    """Return the version of this package."""
    from stiction import __version__

    return __version__
