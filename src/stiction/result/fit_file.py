"""The file of a fit: draws of posterior and prior, further groups, and their basis.

Checksums stand in it as in the file of a run: HDF5's own of each array of numbers, which every
program verifies, and one of the whole file behind the end of HDF5's data.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

from stiction.arrays import xr
from stiction.errors import ResultError
from stiction.result.file import FIT_KIND, as_written, new_netcdf, refuse_layout, sign
from stiction.storage.files import NETCDF, placeable, whole
from stiction.storage.foreign import UNREADABLE, opening
from stiction.storage.version import own_version

LAYOUT = 1


def write_fit(
    path: str | Path,
    posterior: xr.Dataset,
    groups: Mapping[str, xr.Dataset],
    about: Mapping[str, Any],
) -> Path:
    """Write draws of a posterior, and groups beside it, as NetCDF; return the path.

    Parameters
    ----------
    path : str or Path
        Called .nc.
    posterior : Dataset
        Of the root group.
    groups : mapping of str to Dataset
        By the names of their groups.
    about : mapping of str to str or number
        Attributes of the file: what was fitted, and what speaks against it.

    Raises
    ------
    ResultError
        If the file is not called .nc, or cannot be written there.
    """
    target = placeable(path, NETCDF)
    attributes = {FIT_KIND: LAYOUT, "stiction_version": own_version(), **about}
    size = sum(each.nbytes for each in (posterior, *groups.values()))
    with whole(target) as part:
        with new_netcdf(part, size) as file:
            _write(file, posterior.assign_attrs(attributes))
            for name, data in groups.items():
                _write(file.create_group(name), data)
        sign(part)
    return target


def _write(group: Any, data: xr.Dataset) -> None:
    from xarray.backends import H5NetCDFStore

    numbers = [name for name, each in data.variables.items() if each.dtype.kind in "fi"]
    checked = {name: {"fletcher32": True} for name in numbers if data[name].size}
    data.dump_to_store(H5NetCDFStore(group), encoding=checked)


def refuse_damaged_fit(path: str | Path) -> None:
    """Refuse the file of a fit that is not as `write_fit` wrote it.

    Raises
    ------
    ResultError
        If it is damaged, was changed, or has another layout.
    """
    if not as_written(path):
        raise ResultError(f"{path}: is damaged, or was changed; fit the records again")
    h5netcdf: Any = import_module("h5netcdf")  # slow to import
    with opening(path, UNREADABLE), h5netcdf.File(path) as file:
        refuse_layout(path, file.attrs, FIT_KIND, LAYOUT)
