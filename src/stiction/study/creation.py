"""Making the store of a study: whole or not at all, before its first run."""

from __future__ import annotations

import os
import shutil
import tempfile
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stiction.errors import ResultError
from stiction.study.kept import TIME, flagged, kept, trace_times
from stiction.study.plan import Study
from stiction.study.store import ENDS, FORMAT, PENDING, Store, opened, told, version

if TYPE_CHECKING:
    import zarr


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
