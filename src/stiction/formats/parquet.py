"""Parquet, with units in the columns' metadata or names, and dates of any time zone."""

from __future__ import annotations

from pathlib import Path

from stiction.errors import ResultError
from stiction.formats import TextLayout
from stiction.formats.members import Member, tables_of
from stiction.formats.table import FileTable
from stiction.storage.foreign import refuse_size


def read(path: Path, layout: TextLayout) -> list[FileTable]:
    """Return the table of a Parquet file."""
    try:
        from pyarrow import parquet, types
    except ImportError:
        message = "Parquet needs pyarrow; install it with: pip install 'stiction[parquet]'"
        raise ResultError(f"{path}: {message}") from None
    with parquet.ParquetFile(path) as file:
        known = file.metadata
        refuse_size(path, 24.0 * known.num_rows * known.num_columns)
        content = file.read()
    members = []
    for number, field in enumerate(content.schema):
        column = content.column(number)
        unit = (field.metadata or {}).get(b"units", b"").decode("utf-8", "replace")
        if types.is_timestamp(field.type) or types.is_duration(field.type):
            values = column.to_numpy()  # in universal time
        elif types.is_time(field.type):  # of day
            whole = column.cast("int32" if types.is_time32(field.type) else "int64")
            values, unit = whole.cast("float64").to_numpy(), str(field.type.unit)
        elif types.is_integer(field.type) or types.is_floating(field.type):
            values = column.cast("float64").to_numpy()
        else:
            continue
        members.append(Member("", field.name, values, unit))
    return tables_of(members, "Parquet")
