"""From named arrays of a binary file to tables: arrays of one group and length belong together."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.arrays import Floats
from stiction.formats.table import FileColumn, FileTable, Remark, natural_key
from stiction.formats.units import split_unit

LONGEST_TEXT = 400  # characters of a text in a file
WIDE = 64  # columns of an array
SINCE = re.compile(r"(?P<unit>[a-z]+) since (?P<date>\d.*)", re.I)  # the CF conventions, of NetCDF


class Member(NamedTuple):
    """An array, or a text, of a file: its group, its name and its unit.

    `start` is the date and time of the first value, of times that were dates.
    """

    group: str
    name: str
    values: Any
    unit: str = ""
    start: str = ""


def tables_of(members: Iterable[Member], kind: str) -> list[FileTable]:
    """Return a table for each group and length of arrays, step 4 before step 10."""
    groups: dict[tuple[str, int], list[Member]] = {}
    said: list[Remark] = []
    for member in members:
        for each in map(from_first_date, _split(member)):
            values = np.asarray(each.values)
            if values.dtype.kind in "SUO" or values.size == 1:
                said.append(Remark(0, f"{each.group}/{each.name}: {_text(each)}".strip("/")))
            elif values.ndim == 1 and values.dtype.kind in "biuf" and values.size:
                groups.setdefault((each.group, len(values)), []).append(each)
    tables = []
    for group, length in sorted(groups, key=lambda key: (natural_key(key[0]), -key[1])):
        columns = []
        for number, each in enumerate(groups[group, length], 1):
            name, inside = split_unit(each.name)
            values = np.asarray(each.values, dtype=np.float64)
            values = np.where(np.isfinite(values), values, np.nan)
            unit = split_unit(f"x [{each.unit}]")[1] if each.unit else inside
            columns.append(FileColumn(name, values, number, unit or each.unit))
        own = [x for x in said if "/" not in x.text.split(":")[0] or x.text.startswith(f"{group}/")]
        start = next((each.start for each in groups[group, length] if each.start), "")
        tables.append(FileTable(tuple(columns), kind, group, tuple(own), start=start))
    return tables


def from_first_date(member: Member) -> Member:
    """Return dates as times from the first; other values as they are.

    Dates are an array of them, of any resolution, or numbers in a unit "days since 2026-03-01".

    Examples
    --------
    >>> dates = np.array(["2026-03-01T12:00", "2026-03-01T12:01"], "datetime64[m]")
    >>> found = from_first_date(Member("", "time", dates))
    >>> found.values.tolist(), found.unit, found.start
    ([0.0, 60.0], 's', '2026-03-01T12:00')
    >>> from_first_date(Member("", "t", np.array([5, 6]), "days since 2026-03-01")).unit
    'days'
    """
    values = np.asarray(member.values)
    since = SINCE.fullmatch(member.unit.strip())
    if values.dtype.kind in "Mm":
        return _from_first_of(member, values)
    if since is not None and values.dtype.kind in "iuf" and values.size:
        unit, first = since["unit"], values[np.argmax(_present(values))]
        start = f"{first:.15g} {unit} since {since['date']}"
        return member._replace(values=_differences(values, True), unit=unit, start=start)
    return member


def _from_first_of(member: Member, values: NDArray[Any]) -> Member:
    """Return dates, or durations, of NumPy as seconds; from the first one if they are dates."""
    step, count = np.datetime_data(values.dtype)
    known = values[~np.isnat(values)]
    if not known.size or step in ("generic", "Y", "M"):
        return member
    dates = values.dtype.kind == "M"
    per_second = float(np.timedelta64(1, "s") / np.ones((), f"m8[{count}{step}]"))
    seconds = _differences(values.astype(np.int64), dates) / per_second
    return member._replace(values=seconds, unit="s", start=str(known[0]) if dates else "")


def _differences(values: NDArray[Any], dates: bool) -> Floats:
    """Return values less the first known one, where they are dates; NaN where one is missing.

    Whole numbers are subtracted as such: a double has nanoseconds since 1970 to 256 ns.
    """
    known = _present(values)
    first = values[np.argmax(known)] if dates else values.dtype.type(0)
    return np.where(known, (np.where(known, values, first) - first).astype(np.float64), np.nan)


def _present(values: NDArray[Any]) -> NDArray[np.bool_]:
    """Return which numbers are not missing: the least whole number stands for a missing one."""
    if values.dtype.kind == "f":
        return np.asarray(np.isfinite(values))
    least = np.iinfo(values.dtype).min
    return np.asarray(values != least if least else np.ones(values.shape), dtype=np.bool_)


def _split(member: Member) -> Iterable[Member]:
    """Yield the columns of an array with fields or of two dimensions."""
    values = np.asarray(member.values)
    if values.dtype.names:
        for name in values.dtype.names:
            yield from _split(Member(member.group, name, np.squeeze(values[name]), member.unit))
        return
    if values.ndim == 2 and 1 in values.shape:
        values = values.ravel()
    if values.ndim == 2:
        values = values.T if values.shape[0] > values.shape[1] else values
        if len(values) <= WIDE:
            for number, row in enumerate(values, 1):
                yield Member(member.group, f"{member.name} {number}", row, member.unit)
        return
    yield member._replace(values=values)


def _text(member: Member) -> str:
    value = np.asarray(member.values).ravel()
    first = value[0] if value.size == 1 else ""
    unit = f" {member.unit}" if member.unit else ""
    return f"{plain_text(first):.{LONGEST_TEXT}}{unit}"


def plain_text(value: Any) -> str:
    """Return a value of a file as text: bytes, an array of one value, or anything else."""
    value = value[0] if isinstance(value, np.ndarray) and value.size == 1 else value
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)
