"""A study on disk: one zarr array a measure, written block by block, its status last.

The status of a run is -1 until it is known. That of a block is one file, written whole after
all else of that block: it is the mark that the block is done.
"""

from __future__ import annotations

import os
import shutil
import tempfile
import warnings
from collections.abc import Sequence
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple
from uuid import uuid4

import numpy as np

from stiction import errors
from stiction.errors import ResultError
from stiction.study.kept import TIME, Kept, flagged, kept, trace_times
from stiction.study.layout import Index, Layout, Region
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
        places = [str(part.start // b) for part, b in zip(region, block, strict=True)]
        file = store.path.joinpath(name, "c", *places, *["0" for _ in own])
        file.parent.mkdir(parents=True, exist_ok=True)
        part = file.with_name(f".{uuid4().hex}.part")
        try:
            part.write_bytes(chunk.tobytes())
            part.replace(file)
        except OSError:
            part.unlink(missing_ok=True)
            raise

    def _array(store, name: str) -> Any:
        return store.group[name]

    def __reduce__(store) -> tuple[Any, ...]:
        """Pickle by the path: another process opens it for itself."""
        return _reopened, (str(store.path.absolute()), store.layout)


@lru_cache(maxsize=4)
def _reopened(path: str, layout: Layout) -> Store:
    return Store(Path(path), group_at(path), layout)


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


def create(study: Study, path: str | Path) -> Store:
    """Make the store of a study that has not begun, whole or not at all."""
    import zarr

    target = Path(path)
    if not target.parent.is_dir():
        raise ResultError(f"{target}: no folder {target.parent}; make it first")
    with told(target):
        part = Path(tempfile.mkdtemp(dir=target.parent, prefix=f".{target.name}."))
        try:
            _lay_out(study, zarr.create_group(part, zarr_format=3))
            with warnings.catch_warnings():  # of a convention that xarray and zarr share
                warnings.simplefilter("ignore", UserWarning)
                zarr.consolidate_metadata(part)
            part.chmod(0o755)
            os.replace(part, target)
        finally:
            shutil.rmtree(part, ignore_errors=True)
    return opened(study, target)


def _lay_out(study: Study, group: zarr.Group) -> None:
    """Make the arrays of a study and write its coordinates."""
    layout = study.layout
    dims: dict[str, Any] = {"dimension_names": layout.dims}
    grid: dict[str, Any] = {"shape": layout.shape, "chunks": layout.block, "compressors": None}
    group.attrs.update(
        title="study by stiction",
        format=FORMAT,
        stiction_version=version(),
        description=study.to_json(),
        coordinates=" ".join([*study.coordinates, "message"]),  # as xarray reads it
    )
    for each in kept(study):
        group.create_array(
            each.name, dtype=each.dtype, fill_value=each.unknown, attributes=each.labels,
            shape=(*layout.shape, *each.shape), chunks=(*layout.block, *each.shape),
            dimension_names=(*layout.dims, *[TIME for _ in each.shape]), compressors=None,
        )  # fmt: skip
    flags: Any = {"long_name": "how the run ended", **flagged("pending", ENDS)}
    group.create_array(
        "status", dtype=np.int8, fill_value=PENDING, attributes=flags, **dims, **grid
    )
    group.create_array(
        "message", dtype="string", fill_value="", attributes={"long_name": "why the run failed"},
        **dims, **grid,
    )  # fmt: skip
    for path, (dim, values, unit) in study.coordinates.items():
        _write_along(group, path, dim, values, {"units": unit or "1", "long_name": path})
    if study.traces:
        _write_along(group, TIME, TIME, *trace_times(study))


def _write_along(
    group: zarr.Group, name: str, dim: str, values: np.ndarray, labels: dict[str, Any]
) -> None:
    """Write a coordinate."""
    array = group.create_array(
        name, shape=values.shape, chunks=values.shape, dtype=np.float64, attributes=labels,
        dimension_names=(dim,), compressors=None,
    )  # fmt: skip
    array[:] = values


def opened(study: Study, path: str | Path) -> Store:
    """Open the store of a study that has begun.

    Raises
    ------
    ResultError
        If there is something else.
    """
    group = group_at(path)
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


def group_at(path: str | Path) -> zarr.Group:
    """Return what is in the store of a study.

    Raises
    ------
    ResultError
        If it is none.
    """
    import zarr

    if not Path(path).exists():
        raise ResultError(f"{path}: no such store; write one with 'stiction sweep'")
    try:
        group = zarr.open_group(Path(path), mode="r+", use_consolidated=False)
        known = group.attrs.get("format")
    except (OSError, ValueError, KeyError) as error:
        raise ResultError(f"{path}: is not the store of a study: {error}") from None
    if known != FORMAT:
        what = "is not the store of a study" if known is None else f"has format {known}"
        raise ResultError(f"{path}: {what}; choose another name")
    return group


def open_study(path: str | Path) -> xr.Dataset:
    """Return a study's store, its values read when they are asked for.

    It is ``xarray.open_zarr(path)`` after a look at whether it is one.

    Raises
    ------
    ResultError
        If it is none.
    """
    import xarray as xr

    group_at(path)
    data: xr.Dataset = xr.open_zarr(path)
    return data


def version() -> str:
    """Return the version of this package."""
    from stiction import __version__

    return __version__
