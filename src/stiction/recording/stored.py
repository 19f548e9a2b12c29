"""Stored records: NetCDF with the channels, properties of the rig, sensors and origin."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from stiction.arrays import Floats, xr
from stiction.errors import DescriptionError, ResultError
from stiction.formats.channels import CHANNELS
from stiction.recording.guess.clock import rate_of
from stiction.recording.measurement import Measurement
from stiction.recording.origin import Origin, Use
from stiction.recording.request import KNOWN
from stiction.recording.sensor import Sensor
from stiction.result.attributes import SEAL, list_attributes
from stiction.result.file import (
    RECORD_KIND,
    as_written,
    damaged_parts,
    is_netcdf,
    new_netcdf,
    refuse_layout,
    seal_tables,
    sign,
    size_of,
    write_table,
)
from stiction.result.table import Column, ColumnTable, as_table, cf_attributes
from stiction.storage.files import NETCDF, placeable, whole
from stiction.storage.foreign import UNREADABLE, opening, read_through, refuse_other_files
from stiction.storage.isolation import apart
from stiction.storage.version import own_version

LAYOUT = 1  # of a stored record


def write_stored(
    path: str | Path,
    channels: Mapping[str, Floats],
    known: Mapping[str, float],
    sensors: Mapping[str, Sensor],
    origin: Origin | None,
) -> Path:
    """Write channels over time, and all that is known of them, as NetCDF; return the path.

    Raises
    ------
    ResultError
        If the file is not called .nc, or cannot be written there.
    """
    target = placeable(path, NETCDF)
    columns = {
        name: Column(("time",), values, cf_attributes(CHANNELS[name].unit, CHANNELS[name].meaning))
        for name, values in channels.items()
    }
    attributes: dict[str, Any] = {RECORD_KIND: LAYOUT, "stiction_version": own_version()}
    attributes |= {name: float(value) for name, value in known.items()}
    attributes["units_of_attributes"] = ", ".join(f"{name}: {KNOWN[name]}" for name in known)
    attributes["sensors"] = json.dumps({name: _fields(each) for name, each in sensors.items()})
    attributes["origin"] = "" if origin is None else origin.to_json()
    attributes[SEAL] = seal_tables({"record": ColumnTable(columns, attributes)})
    table = ColumnTable(columns, attributes)
    with whole(target) as part:
        with new_netcdf(part, size_of(table)) as file:
            write_table(file, table)
        sign(part)
    return target


def root_attributes(path: Path) -> list[str] | None:
    """Return the names of an HDF5 file's attributes; none of another file, None if damaged."""
    try:
        if not is_netcdf(path):
            return []
        found = as_written(path)
        names = list_attributes(str(path)) if found else apart(list_attributes, path)
    except (OSError, ResultError):
        return None
    return names.split("\n")


def read_stored(path: Path) -> Measurement:
    """Return a record that `write_stored` wrote.

    Raises
    ------
    ResultError
        If the file is damaged.
    """
    if as_written(path) is False:
        raise ResultError(f"{path}: is damaged, its bytes have changed; import the record again")
    if as_written(path) is None:
        apart(read_through, path)
    with opening(path, UNREADABLE):
        refuse_other_files(path)
        data = xr.load_dataset(path, engine="h5netcdf", decode_times=False)
        refuse_layout(path, data.attrs, RECORD_KIND, LAYOUT)
        lost = damaged_parts(data.attrs.get(SEAL), {"record": as_table(data)})
    if lost:
        raise ResultError(f"{path}: is damaged: {', '.join(lost[:3])}; import the record again")
    strange = [str(name) for name in data.variables if name not in CHANNELS]
    if strange or "force" not in data or "time" not in data:
        raise ResultError(f"{path}: is not a stored record; it has {', '.join(map(str, data))}")
    channels = {str(name): each.values.astype(np.float64) for name, each in data.variables.items()}
    try:
        known = {name: float(data.attrs[name]) for name in KNOWN if name in data.attrs}
        sensors = {
            name: Sensor(**fields) for name, fields in json.loads(data.attrs["sensors"]).items()
        }
        origin = (
            Origin.from_json(data.attrs["origin"])
            if data.attrs["origin"]
            else _origin(path, channels)
        )
    except (KeyError, TypeError, ValueError, AttributeError, DescriptionError) as error:
        raise ResultError(f"{path}: its attributes cannot be read: {error}") from None
    return Measurement(channels, known, sensors, origin)


def _fields(sensor: Sensor) -> dict[str, Any]:
    return {name: getattr(sensor, name) for name in type(sensor).model_fields}


def _ends(values: Floats) -> tuple[float, float]:
    """Return the least and the largest value; NaN where there is none."""
    if not len(values):
        return np.nan, np.nan
    return float(np.nanmin(values)), float(np.nanmax(values))


def _origin(path: Path, channels: Mapping[str, Floats]) -> Origin:
    """Return the origin of a record that was made in a session: its own file."""
    uses = tuple(
        Use(0, name, name, CHANNELS[name].unit, *_ends(values)) for name, values in channels.items()
    )
    time = channels["time"]
    return Origin(str(path), "stored record", uses, len(time), rate_of(time))
