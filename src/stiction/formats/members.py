"""From named arrays of a binary file to tables: arrays of one group and length belong together."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from stiction.formats.table import FileColumn, FileTable, Remark, natural_key
from stiction.formats.units import split_unit

LONGEST_TEXT = 400  # characters of a text in a file
WIDE = 64  # columns of an array


class Member(NamedTuple):
    """An array, or a text, of a file: its group, its name and its unit."""

    group: str
    name: str
    values: Any
    unit: str = ""


def tables_of(members: Iterable[Member], kind: str) -> list[FileTable]:
    """Return a table for each group and length of arrays, step 4 before step 10."""
    groups: dict[tuple[str, int], list[Member]] = {}
    said: list[Remark] = []
    for member in members:
        for each in _split(member):
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
        tables.append(FileTable(tuple(columns), kind, label=group, remarks=tuple(own)))
    return tables


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
    """Return what a file holds as text: bytes, an array of one value, or anything else."""
    value = value[0] if isinstance(value, np.ndarray) and value.size == 1 else value
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)
