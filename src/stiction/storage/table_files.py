"""Export of tables to CSV, Parquet and MATLAB."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from math import isfinite
from pathlib import Path
from typing import Any

from stiction.arrays import xr
from stiction.errors import ResultError
from stiction.storage.files import placeable, whole

Tables = Mapping[str, "xr.Dataset"]


def write_tables(tables: Tables, path: str | Path, attributes: Mapping[str, str]) -> list[Path]:
    """Write tables in the format of the path's suffix; return the paths.

    CSV (units in the column heads: ``u_x [m]``) and Parquet (units in the columns' metadata) hold
    one table a file: the first at `path`, the others beside it with their names appended
    (``run-sticks.csv``). MATLAB holds all in one file: a struct for each, and one of the units.

    Parameters
    ----------
    tables : mapping of str to Dataset
        Tables by name.
    path : str or Path
        With the suffix .csv, .parquet or .mat.
    attributes : mapping of str to str
        Metadata of all tables, where the format has a place for them.

    Raises
    ------
    ResultError
        If the format is unknown, needs a missing package, or the file cannot be written.
    """
    first = exportable(path)
    write = FORMATS[first.suffix.lower()]
    if write is _mat:
        with whole(first) as part:
            _mat(tables, part, attributes)
        return [first]
    paths: list[Path] = []
    for name, table in tables.items():
        beside = first.with_name(f"{first.stem}-{name}{first.suffix}") if paths else first
        with whole(placeable(beside)) as part:
            write({name: table}, part, attributes)
        paths.append(beside)
    return paths


def exportable(path: str | Path) -> Path:
    """Return a path, if `write_tables` can write there."""
    return placeable(path, FORMATS)


def with_units(table: xr.Dataset) -> Any:
    """Return a table as a data frame with units in the column names: ``peak [N]``."""
    units = {
        name: f"{name} [{unit}]" for name, unit in units_of(table).items() if unit not in ("", "1")
    }
    return table.to_dataframe().rename(columns=units).rename_axis(index=units)


def units_of(table: xr.Dataset) -> dict[str, str]:
    """Return the unit of each column, '' for none."""
    return {str(name): str(v.attrs.get("units", "")) for name, v in table.variables.items()}


def _csv(tables: Tables, path: Path, attributes: Mapping[str, str]) -> None:
    for table in tables.values():
        with_units(table).to_csv(path)


def _parquet(tables: Tables, path: Path, attributes: Mapping[str, str]) -> None:
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError:
        message = "Parquet needs pyarrow; install it with: pip install 'stiction[parquet]'"
        raise ResultError(f"{message}, or name the file .csv or .mat") from None
    for table in tables.values():
        units = units_of(table)
        columns = pyarrow.Table.from_pandas(table.to_dataframe().reset_index())
        fields = [
            field.with_metadata({"units": units.get(field.name, "")}) for field in columns.schema
        ]
        known = {**(columns.schema.metadata or {}), **attributes}
        parquet.write_table(columns.cast(pyarrow.schema(fields, metadata=known)), path)


def _mat(tables: Tables, path: Path, attributes: Mapping[str, str]) -> None:
    io: Any = import_module("scipy.io")  # slow to import
    structs: dict[str, Any] = {
        _name(name): {_name(column): values.values for column, values in table.variables.items()}
        for name, table in tables.items()
    }
    units = {
        _name(name): {_name(column): unit for column, unit in units_of(table).items()}
        for name, table in tables.items()
    }
    contents = {**structs, "units": units, **attributes}
    io.savemat(path, contents, appendmat=False, long_field_names=True, oned_as="column")


def _name(name: object) -> str:
    """Return a valid MATLAB name."""
    return str(name).replace("-", "_")


FORMATS: dict[str, Callable[[Tables, Path, Mapping[str, str]], None]] = {
    ".csv": _csv,
    ".parquet": _parquet,
    ".mat": _mat,
}


def number(value: Any) -> float | None:
    """Return a number for JSON, None for NaN and infinity."""
    return float(value) if isfinite(float(value)) else None
