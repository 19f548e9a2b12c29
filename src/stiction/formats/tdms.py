"""TDMS of National Instruments, whose channels may start at different times."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from stiction.errors import ResultError
from stiction.formats import TextLayout
from stiction.formats.table import FileColumn, FileTable, Remark
from stiction.storage.foreign import refuse_size


def read(path: Path, layout: TextLayout) -> list[FileTable]:
    """Return a table for each group of channels; each channel has its own clock."""
    try:
        nptdms: Any = import_module("nptdms")
    except ImportError:
        message = "TDMS needs npTDMS; install it with: pip install 'stiction[tdms]'"
        raise ResultError(f"{path}: {message}") from None
    with nptdms.TdmsFile.read_metadata(path) as known:
        values = [float(len(channel)) for group in known.groups() for channel in group.channels()]
    refuse_size(path, 24.0 * sum(values))
    file: Any = nptdms.TdmsFile.read(path)
    cut = getattr(file, "file_status", None)
    tables = []
    for group in file.groups():
        channels = [each for each in group.channels() if len(each)]
        numeric = [each for each in channels if np.asarray(each[:1]).dtype.kind in "iuf"]
        if numeric:
            tables.append(_table(group, numeric, getattr(cut, "incomplete_final_segment", False)))
    return tables


def _table(group: Any, channels: list[Any], cut: bool) -> FileTable:
    """Return one group as a table of the length of its shortest channel."""
    lengths = {len(each) for each in channels}
    rows, notes = min(lengths), []
    if cut:
        notes.append("the file is truncated: its last segment is incomplete")
    if len(lengths) > 1:
        longest = max(lengths)
        notes.append(f"channels have {rows} to {longest} values: those beyond {rows} are left out")
    starts = [each.properties.get("wf_start_time") for each in channels]
    known = [each for each in starts if each is not None]
    first = min(known) if known else None
    columns = []
    for number, (channel, start) in enumerate(zip(channels, starts, strict=True), 1):
        its = channel.properties
        step, offset = its.get("wf_increment"), float(its.get("wf_start_offset", 0.0))
        if start is not None and first is not None:
            offset += float((start - first) / np.timedelta64(1, "ns")) * 1e-9
        clock = offset + float(step) * np.arange(rows, dtype=np.float64) if step else None
        unit = str(its.get("unit_string") or its.get("NI_UnitDescription") or "")
        values = np.asarray(channel[:rows], dtype=np.float64)
        columns.append(FileColumn(channel.name, values, number, unit, clock))
    remarks = [Remark(0, f"{name}: {value}") for name, value in group.properties.items()]
    begins = "" if first is None else str(first)[:23]
    return FileTable(
        tuple(columns),
        "TDMS",
        label=group.name,
        remarks=tuple(remarks),
        notes=tuple(notes),
        start=begins,
    )
