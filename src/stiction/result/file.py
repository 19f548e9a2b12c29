"""The file of a run, and the checksums of everything that is read back from it.

Each array has HDF5's own checksum (fletcher32), which every program verifies. It does not protect
names, attributes, or the tables that locate an array in the file: one attribute holds the checksums
of these. The checksum of the whole file stands behind the end of HDF5's data, where no reader
looks. It shows that a file is intact without HDF5, which may crash on damage. Other programs that
write into the file remove it.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib import import_module
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from stiction.errors import Instruction, ResultError, argument, echo
from stiction.machine import shortage
from stiction.result.attributes import DESCRIPTION, SEAL
from stiction.result.table import STICKS, VARIABLES, Column, ColumnTable
from stiction.storage.checksums import LENGTH, broken_parts, bytes_of, crc_of_file, seal
from stiction.storage.foreign import UNREADABLE, opening, read_through, refuse_other_files
from stiction.storage.isolation import apart
from stiction.storage.kinds import HDF5, RESULT, use_of
from stiction.storage.version import own_version

STICK_GROUP = "sticks"  # group of a result file
GROWING = 2.0  # times its size, the memory of a file that grows in it
CHUNK = 2**16  # samples per checksum of HDF5
ENDS = ("stick_start", "stick_end")
TEXTS = ("description", "status", "stiction_version")
SHORTEST = 1e-100  # s, between two samples
LATER = {"mu", "stick_duration"}  # columns that older versions did not write
RESULT_KIND = "stiction_result"  # attribute of the file of a run; its value: the layout
RECORD_KIND = "stiction_record"  # the same of a stored record
FIT_KIND = "stiction_fit"  # and of the file of a fit
LAYOUT = 1  # of the file of a run; up to version 0.4 it states none
MAKE = Instruction("write one with 'stiction run'", "run.save(path) writes one")
OTHER_KINDS = {
    RECORD_KIND: Instruction(
        "is a record, not the result of a run; stiction analyse {path} and "
        "st.read_record read it, whose export(...) writes a table",
        "is a record, not the result of a run; st.analyse({text}) and st.read_record({text}) read "
        "it, whose export(...) writes a table",
    ),
    FIT_KIND: Instruction(
        "is the file of a fit; xarray.open_dataset reads it, whose to_dataframe() is a table, and "
        "stiction check {path} looks for damage",
        "is the file of a fit; xarray.open_dataset reads it, whose to_dataframe() is a table, and "
        "st.check({text}) looks for damage",
    ),
}
ATTRIBUTES = "attributes"  # what checksums call all attributes but the description
MARK = b"stiction crc-32c"  # precedes the checksum of a whole file


def write_result(samples: ColumnTable, sticks: ColumnTable, path: Path) -> None:
    """Write samples and sticks with checksums."""
    tables = _tables_of(samples, sticks)
    about = {**tables["samples"].attributes, SEAL: seal_tables(tables)}
    with new_netcdf(path, size_of(samples, sticks)) as file:
        write_table(file, ColumnTable(samples.columns, about))
        write_table(file.create_group(STICK_GROUP), sticks)
    sign(path)


def unlike_parts(known: str, samples: ColumnTable, sticks: ColumnTable) -> list[str]:
    """Return the parts of a run that differ from the one with these checksums."""
    return damaged_parts(known, _tables_of(samples, sticks))


def _tables_of(samples: ColumnTable, sticks: ColumnTable) -> dict[str, ColumnTable]:
    """Return the tables of a result file as they are sealed."""
    about = {RESULT_KIND: LAYOUT, **samples.attributes}
    return {"samples": ColumnTable(samples.columns, about), "sticks": sticks}


@contextmanager
def new_netcdf(path: Path, size: int) -> Iterator[Any]:
    """Yield a file for `size` bytes of arrays, made in memory: HDF5 crashes where a disk is full.

    Only arrays that do not fit into memory once more go straight to the disk.
    """
    h5netcdf: Any = import_module("h5netcdf")  # slow to import
    made = path if shortage(GROWING * size) else BytesIO()
    with h5netcdf.File(made, "w") as file:
        yield file
    if isinstance(made, BytesIO):
        path.write_bytes(made.getbuffer())


def write_table(group: Any, table: ColumnTable) -> None:
    """Write a table into a group of a file, with HDF5's checksum of each array."""
    group.attrs.update(table.attributes)
    for name, (dims, values, attributes) in table.columns.items():
        for dim, size in zip(dims, values.shape, strict=True):
            if dim not in group.dimensions:
                group.dimensions[dim] = size
        number = values.dtype.kind == "f"
        how = {"fletcher32": True, "chunks": (min(values.size, CHUNK),)} if values.size else {}
        column = group.create_variable(
            name, dims, values.dtype, fillvalue=values.dtype.type(np.nan) if number else None, **how
        )
        column.attrs.update(attributes)
        column[...] = values


def size_of(*tables: ColumnTable) -> int:
    """Return the size of the arrays of tables, bytes."""
    return sum(column.values.nbytes for each in tables for column in each.columns.values())


def repair_of(path: str | Path) -> Instruction:
    """Return the instruction that computes damaged parts of a file or a store again."""
    return Instruction(
        f"stiction check {argument(path)} --repair", f"st.check({str(path)!r}, repair=True)"
    )


class DamageError(ResultError):
    """A result has changed since it was written; `lost` lists the places."""

    def __init__(self, path: str | Path, lost: Sequence[str]) -> None:
        """Name the first places, and the command that computes the result again."""
        self.lost = ", ".join(lost[:3])
        again = f"compute it again with: {repair_of(path)}"
        super().__init__(f"{path}: is damaged, or was changed: {self.lost}; {again}")
        self._made_of = path, lost


class SelectionError(ResultError):
    """The arrays of a result are whole, but were cut or chosen from by another program."""

    def __init__(self, path: str | Path) -> None:
        """Name the way to read it; a repair would put the whole run in its place."""
        as_record = Instruction(
            f"stiction import {argument(path)} -o record.nc", f"st.read_record({str(path)!r})"
        )
        self._made_of = path
        super().__init__(
            f"{path}: is a part of a result, which another program wrote; read it as a record: "
            f"{as_record}"
        )

    def __reduce__(self) -> tuple[type[SelectionError], tuple[str | Path]]:
        """Pickle the parts of the message."""
        return type(self), (self._made_of,)


def is_selection(samples: ColumnTable, lost: Sequence[str]) -> bool:
    """Return whether another program cut the samples of a run, by its parts that have changed.

    A cut changes every array, by its length, and leaves times that ascend; damage changes some.
    """
    time = samples.columns.get("time")
    if time is None or time.values.dtype.kind != "f" or DESCRIPTION in lost:
        return False
    whole = all(f"samples.{name}" in lost for name in samples.columns)
    alike = all(len(each.values) == len(time.values) for each in samples.columns.values())
    ascends = np.isfinite(time.values).all() and (np.diff(time.values) > 0.0).all()
    return bool(whole and alike and ascends and len(time.values))


class LayoutError(ResultError):
    """A file has another layout than the one that is read here."""


def read_tables(path: str | Path) -> tuple[ColumnTable, ColumnTable]:
    """Return samples and sticks of a result file.

    Raises
    ------
    ResultError
        If there is no such file, or it is not a result of this package.
    """
    if os.path.isdir(path):
        study = "of a study, st.map(path) draws a map and st.open_study(path) reads the data"
        use = use_of(path, RESULT) or study
        raise ResultError(f"{path}: is a folder, not the file of one run; {use}")
    if not os.path.isfile(path):
        use = use_of(path) or str(MAKE)
        raise ResultError(f"{path}: no such file; {use}")
    with opening(path, UNREADABLE):
        _refuse_what_is_no_netcdf(path)
        whole = as_written(path)
    if whole is False:
        raise DamageError(path, ["its bytes have changed"])
    if whole is None:  # HDF5 may crash on it
        apart(read_through, path)
    with opening(path, UNREADABLE):
        refuse_other_files(path)
        data, sticks, checked = open_tables(path)
        refuse_kinds(path, data.attributes, OTHER_KINDS)
        if RESULT_KIND in data.attributes:
            refuse_layout(path, data.attributes, RESULT_KIND, LAYOUT)
        sealed = data.attributes.get(SEAL)
        lost = damaged_parts(sealed, {"samples": data, "sticks": sticks}) if checked else []
    if lost and whole is None and is_selection(data, lost):
        raise SelectionError(path)
    if lost:
        raise DamageError(path, lost)
    about = {n: value for n, value in data.attributes.items() if n not in (SEAL, RESULT_KIND)}
    data = ColumnTable(data.columns, about)
    lacking = [*_lacking(data, VARIABLES), *_lacking(sticks, ENDS)]
    lacking += ["its description"] if "description" not in about else []
    if lacking:
        what = f"it lacks {', '.join(lacking)}"
        if lacking == [*ENDS]:
            what += ", as what run.data.to_netcdf(...) writes; run.save(...) writes a whole result"
        raise ResultError(f"{path}: not the result of a run; {what}{age(about)}")
    wrong = [*_wrong(data, "time", ["time", *VARIABLES]), *_wrong(sticks, "stick", STICKS)]
    wrong += [f"{name} is not text" for name in TEXTS if not isinstance(about.get(name), str)]
    if wrong:
        raise ResultError(f"{path}: not the result of a run; {'; '.join(wrong)}{age(about)}")
    return data, sticks


def _refuse_what_is_no_netcdf(path: str | Path) -> None:
    """Refuse a file that is not NetCDF, such as a measured record."""
    if not is_netcdf(path):
        reader = Instruction("'stiction analyse'", "st.read_record")
        use = use_of(path, RESULT) or f"{MAKE}; a measured record is read by {reader}"
        raise ResultError(f"{path}: not a NetCDF file; {use}")


def is_netcdf(path: str | Path) -> bool:
    """Return whether a file begins as NetCDF does."""
    with open(path, "rb") as file:
        return file.read(len(HDF5)) == HDF5


def refuse_kinds(path: str | Path, attributes: Iterable[str], kinds: Iterable[str]) -> None:
    """Refuse a file with such attributes (their names suffice) that is of one of these kinds."""
    for kind in kinds:
        if kind in attributes:
            said = str(OTHER_KINDS[kind]).format(path=argument(path), text=repr(str(path)))
            raise ResultError(f"{path}: {said}")


def refuse_layout(path: str | Path, attributes: Mapping[str, Any], kind: str, layout: int) -> None:
    """Refuse a file of a kind whose layout is not the one that is known."""
    stated = np.asarray(attributes[kind]).tolist()
    if stated not in (layout, [layout]):
        told = f"has layout {echo(stated)}, and layout {layout} is read here{age(attributes)}"
        raise LayoutError(f"{path}: {told}; read it with the version that wrote it")


def age(attributes: Mapping[str, Any]) -> str:
    """Return a note on the version that wrote a file, '' if it is this one."""
    wrote, this = attributes.get("stiction_version"), own_version()
    if wrote is None or str(wrote) == this:
        return ""
    return f"; stiction {wrote!s:.20} wrote it, this is {this}"


def open_tables(path: str | Path) -> tuple[ColumnTable, ColumnTable, bool]:
    """Return the two tables of a file, and whether it has checksums, as from version 0.5 on.

    Up to version 0.4 both are in the root group. xarray would take longer to import than to draw.
    """
    h5netcdf: Any = import_module("h5netcdf")  # slow to import
    with h5netcdf.File(path, "r", phony_dims="sort") as file:
        groups = [file, *([file[STICK_GROUP]] if STICK_GROUP in file.groups else [])]
        tables = [_table_of(group) for group in groups]
        checked = any(each.fletcher32 for group in groups for each in group.variables.values())
    data = tables[0]
    samples, old = (
        {n: each for n, each in data.columns.items() if ("stick" in each.dims) is its}
        for its in (False, True)
    )
    sticks = ColumnTable(old, {}) if old else tables[-1] if tables[1:] else ColumnTable({}, {})
    return ColumnTable(samples, data.attributes), sticks, checked or SEAL in data.attributes


def _table_of(group: Any) -> ColumnTable:
    """Return the columns and attributes of a group of a file."""
    columns = {}
    for name, each in group.variables.items():
        about = {key: value for key, value in each.attrs.items() if key != "_FillValue"}
        columns[name] = Column(tuple(each.dimensions), np.asarray(each[...]), about)
    return ColumnTable(columns, dict(group.attrs))


def _lacking(table: ColumnTable, names: Iterable[str]) -> list[str]:
    return [name for name in names if name not in table.columns and name not in LATER]


def _wrong(table: ColumnTable, dim: str, names: Iterable[str]) -> Iterator[str]:
    """Yield the faults of numeric columns along one dimension."""
    for name in names:
        if name not in table.columns:
            continue
        column = table.columns[name]
        if column.values.dtype.kind not in "fiu" or column.dims != (dim,):
            along = ", ".join(map(str, column.dims)) or "nothing"
            yield f"{name} is {column.values.dtype} along {along}, and must be numbers along {dim}"
        elif name in ("time", *ENDS):
            values = column.values.astype(np.float64)
            least = SHORTEST if name == "time" else 0.0
            if not np.isfinite(values).all() or (np.diff(values) < least).any():
                yield f"{name} must be finite and ascend"
            elif name == "time" and not len(values):
                yield "it has no samples"


def seal_tables(tables: Mapping[str, ColumnTable]) -> str:
    """Return the checksums of tables as the text of an attribute."""
    return seal(_parts(tables))


def damaged_parts(known: str | None, tables: Mapping[str, ColumnTable]) -> list[str]:
    """Return the names of damaged parts, by the text of `seal_tables`."""
    return [SEAL] if known is None else broken_parts(known, _parts(tables))


def _parts(tables: Mapping[str, ColumnTable]) -> dict[str, Any]:
    """Return the contents of tables: each array's numbers, and all attributes together."""
    numbers: dict[str, Any] = {}
    attributes: dict[str, Any] = {}
    for name, table in tables.items():
        kept = {key: value for key, value in table.attributes.items() if key != SEAL}
        if DESCRIPTION in kept:
            numbers[DESCRIPTION] = str(kept.pop(DESCRIPTION)).encode()
        attributes[name] = _plain(kept)
        for column, (dims, values, about) in table.columns.items():
            numbers[f"{name}.{column}"] = bytes_of(values)
            attributes[f"{name}.{column}"] = [values.dtype.kind, dims, _plain(about)]
    return {**numbers, ATTRIBUTES: json.dumps(attributes, sort_keys=True).encode()}


def _plain(attributes: Mapping[Any, Any]) -> dict[str, Any]:
    """Return attributes as plain numbers, texts and lists, independent of the file format."""
    plain = {str(name): np.asarray(value).tolist() for name, value in attributes.items()}
    return {
        name: value[0] if isinstance(value, list) and len(value) == 1 else value
        for name, value in plain.items()
    }


def sign(path: str | Path) -> None:
    """Append a file's checksum to it."""
    own = crc_of_file(path)
    with open(path, "ab") as file:
        file.write(MARK + own)


def as_written(path: str | Path) -> bool | None:
    """Return whether a file matches its appended checksum; None if it has none."""
    end = len(MARK) + LENGTH
    with open(path, "rb") as file:
        size = file.seek(0, os.SEEK_END)
        file.seek(max(size - end, 0))
        mark, own = file.read(len(MARK)), file.read()
    return crc_of_file(path, size - end) == own if mark == MARK else None
