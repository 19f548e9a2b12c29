"""Creation of a study's store, whole or not at all, before its first run."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stiction.errors import ResultError
from stiction.storage.files import NETCDF, place, usable_folder, workshop
from stiction.storage.version import own_version
from stiction.study.plan.study import Study
from stiction.study.store.kept import TIME, flag_attributes, stored_variables, trace_times
from stiction.study.store.seal import seal
from stiction.study.store.store import (
    CHECKED,
    ENDS,
    PENDING,
    Store,
    errors_as_message,
    open_store,
)

if TYPE_CHECKING:
    import zarr


def create(study: Study, path: str | Path) -> Store:
    """Create the store of a new study, or open it if another sweep was faster."""
    target = Path(path)
    if target.suffix.lower() in NETCDF:
        raise ResultError(
            f"{target}: a study is kept in a folder, not in a NetCDF file; name it "
            f"{target.stem}.zarr"
        )
    usable_folder(target)
    with errors_as_message(target), workshop(target.parent) as room:
        part = lay_out(study, room / "store")
        try:
            place({part: target})
        except OSError:
            if not target.exists():  # otherwise another sweep was faster
                raise
    return open_store(study, target)


def lay_out(study: Study, folder: Path) -> Path:
    """Make an empty, sealed store; return the folder."""
    import zarr

    _make_arrays(study, zarr.create_group(folder, zarr_format=3))
    with warnings.catch_warnings():  # zarr warns of consolidated metadata
        warnings.simplefilter("ignore", UserWarning)
        zarr.consolidate_metadata(folder)
    seal(folder)
    return folder


def _make_arrays(study: Study, group: zarr.Group) -> None:
    """Make the arrays of a study and write its coordinates."""
    from zarr.codecs import Crc32cCodec

    layout, codecs = study.layout, (Crc32cCodec(),)
    dims: dict[str, Any] = {"dimension_names": layout.dims}
    grid: dict[str, Any] = {"shape": layout.shape, "chunks": layout.block, "compressors": codecs}
    group.attrs.update(
        title="study by stiction",
        format=CHECKED,
        stiction_version=own_version(),
        description=study.to_json(),
        coordinates=" ".join([*study.coordinates, "message"]),  # as xarray reads it
    )
    for each in stored_variables(study):
        group.create_array(
            each.name, dtype=each.dtype, fill_value=each.unknown, attributes=each.labels,
            shape=(*layout.shape, *each.shape), chunks=(*layout.block, *each.shape),
            dimension_names=(*layout.dims, *[TIME for _ in each.shape]), compressors=codecs,
        )  # fmt: skip
    flags: Any = {"long_name": "how the run ended", **flag_attributes("pending", ENDS)}
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
    from zarr.codecs import Crc32cCodec

    array = group.create_array(
        name, shape=values.shape, chunks=values.shape, dtype=np.float64, attributes=labels,
        dimension_names=(dim,), compressors=(Crc32cCodec(),),
    )  # fmt: skip
    array[:] = values
