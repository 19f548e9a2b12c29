"""A study on disk: one zarr array per measure, written block by block, the status last.

The status of a run is -1 until it is known. The status of a block is one file, written after the
rest of the block is on the disk: it marks the block as done. Each chunk has a checksum, and so have
the files that are written when the store is made. Stores of format 1 have no checksums.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from functools import lru_cache
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from stiction import errors
from stiction.arrays import xr
from stiction.errors import Instruction, ResultError
from stiction.storage.checksums import LENGTH, with_checksum, without_checksum
from stiction.storage.files import claim, place, reason, workshop
from stiction.storage.foreign import opening, refuse_links, refuse_size
from stiction.storage.kinds import STORE, use_of
from stiction.storage.version import own_version
from stiction.study.plan.layout import MANY_TASKS, Index, Layout, Region
from stiction.study.plan.study import Study
from stiction.study.store import seal
from stiction.study.store.kept import Kept, names_kept
from stiction.study.variables.measures import FORMERLY

if TYPE_CHECKING:
    import zarr

FORMATS = (1, 2)  # of readable stores
CHECKED = 2  # the format that is written, the first with checksums
MAKE = Instruction("make one with 'stiction sweep'", "st.sweep(study, path) makes one")
PENDING = -1
MOST_TASKS = 256 * MANY_TASKS  # that a store may claim: each block is visited
# ends of a run in a study: those of any run, refused before it began, or an error of the program;
# a store holds their places, so that what is new comes last
OF_ANY_RUN = [status.name.lower() for status in errors.Status]
ENDS = (*OF_ANY_RUN[:5], "refused", "error", *OF_ANY_RUN[5:])
COMPLETED, REFUSED, ERROR = 0, ENDS.index("refused"), ENDS.index("error")
STATUS, MESSAGE = "status", "message"
CLAIM = ".claim-"  # prefix of the files of blocks that sweeps are doing, beside the blocks' status


class BlockResults(NamedTuple):
    """Results of a region's runs: arrays of the region's shape plus each value's shape."""

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
        Its content.
    layout : Layout
        The layout of its runs and blocks.
    chunks : mapping of str to tuple of int
        The chunk shape of each array of values per run; each block is one chunk.
    identity : str
        The identity of its initial files: another store may take its place.
    """

    path: Path
    group: zarr.Group
    layout: Layout
    chunks: Mapping[str, Index]
    identity: str

    @property
    def checked(self) -> bool:
        """Whether chunks have checksums."""
        return bool(self.group.attrs["format"] == CHECKED)

    def status(self) -> np.ndarray:
        """Return the status of every run."""
        return np.asarray(self._array(STATUS)[...])

    def has(self, region: Region) -> bool:
        """Return whether a block is marked as done, with no file missing or truncated."""
        return self.mark(region).is_file() and not self.damaged_files(region)

    def mark(self, region: Region) -> Path:
        """Return the status file of a block, which marks it as done."""
        return self._file(STATUS, region)

    def claim(self, task: int) -> AbstractContextManager[bool]:
        """Claim a block for this sweep: see `stiction.storage.files.claim`."""
        return claim(self.path / STATUS / f"{CLAIM}{task}")

    def drop_claims(self) -> None:
        """Remove the claims of killed sweeps."""
        for each in (self.path / STATUS).glob(f"{CLAIM}*"):
            with claim(each):
                pass

    def damaged_files(self, region: Region, *, read: bool = False) -> list[Path]:
        """Return the damaged files of a block that is marked as done.

        They are missing or have a wrong length, or, if `read`, a wrong checksum.
        """
        mark = self.mark(region)
        if not mark.exists():
            return []
        status = self._content(mark, self._size(STATUS))
        if status is None:
            return [mark]
        sizes = {self._file(name, region): self._size(name) for name in self.chunks}
        found = [file for file, size in sizes.items() if not self._sound(file, size, read)]
        if (np.frombuffer(status, np.int8) > COMPLETED).any():  # failed runs have a message
            file = self._file(MESSAGE, region)
            found += [file] if self._content(file) is None else []
        return found

    def _size(self, name: str) -> int:
        """Return the size of a chunk on disk, in bytes."""
        numbers = prod(self.chunks[name]) * self._array(name).dtype.itemsize
        return int(numbers) + (LENGTH if self.checked else 0)

    def _sound(self, file: Path, size: int, read: bool) -> bool:
        if read:
            return self._content(file, size) is not None
        return file.is_file() and file.stat().st_size == size

    def _content(self, file: Path, size: int | None = None) -> bytes | None:
        """Return the content of a chunk without its checksum; None if it is damaged."""
        if not file.is_file():
            return None
        content = file.read_bytes()
        if size not in (None, len(content)) or not content:
            return None
        return without_checksum(content) if self.checked else content

    def message(self, index: Index) -> str:
        """Return why a run failed."""
        with opening(self.path, "is damaged"):
            return str(self._array(MESSAGE)[index])

    def messages(self) -> np.ndarray:
        """Return the messages of all runs; '' where there is none."""
        with opening(self.path, "is damaged"):
            return np.asarray(self._array(MESSAGE)[...], dtype=object)

    def write(self, region: Region, block: BlockResults) -> None:
        """Write a block to the disk, then the mark that it is done.

        Raises
        ------
        ResultError
            If another store has taken its place, or the disk refuses.
        """
        _refuse_replaced(self.path, self.identity)
        files = {
            self._file(each.name, region): self._whole(values, each.unknown).tobytes()
            for each, values in block.values
        }
        if block.message.any():
            files[self._file(MESSAGE, region)] = encode_texts(self._whole(block.message, ""))
        with errors_as_message(self.path):
            self._place(files)
            self._place({self.mark(region): self._whole(block.status, PENDING).tobytes()})

    def _place(self, files: Mapping[Path, bytes]) -> None:
        """Write chunks by zarr's specification: each as a file of bytes.

        Writing through zarr takes eight times as long, as much as a sixth of a run.
        """
        with workshop(self.path / STATUS) as room:
            made = {}
            for number, (file, content) in enumerate(files.items()):
                part = room / str(number)
                part.write_bytes(with_checksum(content) if self.checked else content)
                made[part] = file
            place(made)

    def _whole(self, values: np.ndarray, fill: Any) -> np.ndarray:
        """Return a block's values as a full chunk, padded beyond the edges of the grid."""
        own = values.shape[len(self.layout.block) :]
        chunk = np.full((*self.layout.block, *own), fill, values.dtype.newbyteorder("<"))
        chunk[tuple(slice(0, n) for n in values.shape)] = values
        return chunk

    def _file(self, name: str, region: Region) -> Path:
        """Return the file of a region's chunk; only dimensions of the grid are divided."""
        pairs = zip(region, self.layout.block, strict=True)
        places = (str(part.start // b) for part, b in pairs)
        own = len(self.chunks.get(name, region)) - len(region)
        return self.path.joinpath(name, "c", *places, *["0"] * own)

    def _array(self, name: str) -> Any:
        return self.group[name]

    @property
    def address(self) -> StoreAddress:
        """Where other processes find it."""
        return StoreAddress(self.path.absolute(), self.identity)


def encode_texts(texts: np.ndarray) -> bytes:
    """Encode texts like zarr's codec vlen-utf8: their number, then each length and content."""
    contents = [str(text).encode() for text in texts.ravel()]
    lengths = np.array([len(contents), *map(len, contents)], "<u4")
    pairs = zip(lengths[1:], contents, strict=True)
    return lengths[:1].tobytes() + b"".join(n.tobytes() + content for n, content in pairs)


class StoreAddress(NamedTuple):
    """The place of a store, for the processes of a sweep: each opens the store itself.

    Parameters
    ----------
    path : Path
        The folder.
    identity : str
        The identity of the store that is meant: a process may outlive it.
    """

    path: Path
    identity: str

    def store(self) -> Store:
        """Open the store for writing, once in each process.

        Raises
        ------
        ResultError
            If another store has taken its place.
        """
        _refuse_replaced(self.path, self.identity)
        return _open_once(*self)


@lru_cache(maxsize=4)
def _open_once(path: Path, _identity: str) -> Store:
    return store_at(path, "r+")


def _refuse_replaced(path: Path, identity: str) -> None:
    """Refuse a path where the store of a sweep was removed or replaced by another one."""
    if seal.identity(path) != identity:
        raise ResultError(
            f"{path}: was removed or replaced by another store during the sweep; sweep the study "
            "again"
        )


@contextmanager
def errors_as_message(path: Path) -> Iterator[None]:
    """Turn errors of the file system into a message."""
    try:
        yield
    except OSError as error:
        raise ResultError(
            f"{path}: cannot be written: {reason(error)}; its content is intact; "
            "afterwards repeat the command"
        ) from None


def open_store(study: Study, path: str | Path) -> Store:
    """Open the existing store of a study.

    Raises
    ------
    ResultError
        If something else is there.
    """
    store = store_at(path, "r+")
    attributes = store.group.attrs
    held = attributes.get("description")
    if held != study.to_json():
        raise ResultError(
            f"{path}: holds another study{_difference(str(held), study)}; it was not "
            "overwritten: choose another name, or remove it"
        )
    if attributes.get("stiction_version") != own_version():
        raise ResultError(
            f"{path}: was begun by stiction {attributes.get('stiction_version')}, this is "
            f"{own_version()}; continue with that version, or choose another name"
        )
    return store


def _difference(held: str, study: Study) -> str:
    """Return the first value in which a stored study differs from another one, in words."""
    try:
        there, here = json.loads(held), study.to_dict()
    except ValueError:
        return ""
    found = first_difference(there, json.loads(json.dumps(here)))
    if found is None:  # axes are dimensions, in their order
        return ", whose tables stand in another order"
    name, *values = found
    said = ("nothing" if each is None else errors.echo(each) for each in values)
    return f": {name} is {next(said)} there and {next(said)} here"


def first_difference(there: Any, here: Any, path: str = "") -> tuple[str, Any, Any] | None:
    """Return the path of the first value that differs between tables, and both; None if equal.

    Elements of a list count from 1, as in all paths. None stands for a missing value.

    >>> first_difference({"run": {"rtol": 1e-4}, "axes": [1]}, {"run": {"rtol": 1e-4}, "axes": [2]})
    ('axes.1', 1, 2)
    """
    if isinstance(there, list) and isinstance(here, list):
        there, here = ({str(at): each for at, each in enumerate(its, 1)} for its in (there, here))
    if not (isinstance(there, Mapping) and isinstance(here, Mapping)):
        return None if there == here else (path, there, here)
    for key in (*there, *(each for each in here if each not in there)):
        inner = f"{path}.{key}" if path else key
        if (found := first_difference(there.get(key), here.get(key), inner)) is not None:
            return found
    return None


def store_at(path: str | Path, mode: Literal["r", "r+"]) -> Store:
    """Open a store by its own description.

    Raises
    ------
    ResultError
        If it is not a store, or its description or metadata are damaged.
    """
    group, identity = group_at(path, mode), seal.identity(Path(path))
    lost = seal.broken_files(Path(path)) if group.attrs["format"] == CHECKED else []
    try:
        study = json.loads(str(group.attrs["description"]))["study"]
        status: Any = group[STATUS]
        layout = Layout(tuple(status.metadata.dimension_names), status.shape, status.chunks)
        arrays: dict[str, Any] = {name: group[name] for name in (*names_kept(study), STATUS)}
        group[MESSAGE]
    except errors.StictionError:
        raise
    except KeyError as error:
        raise seal.damage(path, lost or [f"it lacks {error}"]) from None
    except Exception as error:  # zarr raises anything where metadata are damaged
        raise seal.damage(path, lost or [errors.one_line(error)]) from None
    if lost:
        raise seal.damage(path, lost)
    if layout.tasks > MOST_TASKS:
        raise ResultError(
            f"{path}: is damaged: a study cannot have {layout.tasks:,} blocks of runs"
        )
    chunks = {name: each.chunks for name, each in arrays.items()}
    return Store(Path(path), group, layout, chunks, identity)


def group_at(path: str | Path, mode: Literal["r", "r+"]) -> zarr.Group:
    """Return the zarr group of a study's store.

    Raises
    ------
    ResultError
        If it is none.
    """
    import zarr

    if not os.path.isdir(path):
        what = "a file, not the store of a study" if os.path.isfile(path) else "no such store"
        use = use_of(path, STORE) or MAKE
        raise ResultError(f"{path}: {what}; {use}")
    refuse_links(path)
    was = (Path(path) / STATUS / seal.ROOT).is_file()
    what = f"is damaged: {seal.ROOT}; {seal.ANEW}" if was else "is not the store of a study"
    if not was and not (Path(path) / seal.ROOT).is_file():
        raise ResultError(f"{path}: {what}; {MAKE}")
    with opening(path, what):  # zarr's format 2 may contain pickles
        group = zarr.open_group(Path(path), mode=mode, zarr_format=3, use_consolidated=False)
        known = group.attrs.get("format")
    if known not in FORMATS:
        wrote = f"{group.attrs.get('stiction_version')!s:.20}"
        by = f"stiction {wrote} wrote it, this is {own_version()}"
        what = "is not the store of a study" if known is None else f"has format {known!s:.20}; {by}"
        raise ResultError(f"{path}: {what}; choose another name")
    return group


def open_study(path: str | Path) -> xr.Dataset:
    """Open a study's store lazily: values are read when they are used.

    Like ``xarray.open_zarr(path)``, but it checks that the path is a store and that no files are
    missing, and gives the measures of older stores their present names.

    Raises
    ------
    ResultError
        If it is not a store, or is damaged; damaged values raise it when they are read.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> base = st.Description.of(slider, "20 ms")
    >>> axes = {"phi": st.Grid("1 deg", "3 deg", 3)}
    >>> study = st.Study(base=base, axes=axes, measures=["stick_count"])
    >>> done = st.sweep(study, "phi.zarr")
    >>> st.open_study("phi.zarr")["stick_count"].values.tolist()
    [9.0, 15.0, 17.0]
    """
    from zarr.storage import LocalStore

    from stiction.study.store.chunks import WholeChunks

    store = store_at(path, "r")
    with opening(path, "is damaged"):
        found = [store.group[file.parent.name] for file in Path(path).glob("*/zarr.json")]
    arrays: list[Any] = [each for each in found if hasattr(each, "nbytes")]
    refuse_size(path, sum(float(each.nbytes) for each in arrays if each.ndim == 1))
    layout = store.layout
    lost = [
        file for task in range(layout.tasks) for file in store.damaged_files(layout.region(task))
    ]
    if lost:
        raise seal.damage(path, [file.relative_to(path) for file in lost])
    files: Any = WholeChunks(LocalStore(path, read_only=True)) if store.checked else path
    with opening(path, "is damaged"):
        data: xr.Dataset = xr.open_zarr(files, zarr_format=3)
    data.encoding["source"] = str(path)  # as xarray names the files that it opens
    return data.rename({old: new for old, new in FORMERLY.items() if old in data})
