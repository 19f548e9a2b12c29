"""The results of an analysis as files: CSV for each table, JSON for the numbers."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stiction.analysis.parts import functions
from stiction.analysis.parts.cycles import each_cycle, turns_with_drive
from stiction.analysis.record import Record
from stiction.arrays import xr
from stiction.storage.files import placeable, whole, write_text
from stiction.storage.table_files import with_units, write_tables
from stiction.text.columns import rows_left_out
from stiction.text.sections import Section

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis


def tables(found: Analysis) -> dict[str, xr.Dataset]:
    """Return all tables with rows, by name."""
    named = {name: each for _, of in functions("tables") for name, each in of(found).items()}
    return {
        name: table for name, table in named.items()
        if table is not None and 0 not in table.sizes.values()
    }  # fmt: skip


def numbers(found: Analysis) -> dict[str, Any]:
    """Return the numbers of an analysis, in SI and rad, for JSON; null for unknown ones."""
    known = {name: each for _, of in functions("numbers") for name, each in of(found).items()}
    return known | {"warnings": list(found.warnings), "missing": found.missing}


def full_report(found: Analysis) -> list[Section]:
    """Return the report with the first cycles, and with how a record was read from its file."""
    parts, count = found.tables(), found.cycles.sizes["cycle"]
    if count and not turns_with_drive(found):
        at = [part.title for part in parts].index("Cycles") + 1
        more = rows_left_out(count, "cycles", "cycles.csv")
        parts.insert(at, Section("Cycle by cycle", more, each_cycle(found.cycles)))
    if isinstance(found.source, Record) and found.source.origin is not None:
        parts += found.source.origin.tables()
    return parts


def write(found: Analysis, folder: Path) -> list[Path]:
    """Write all tables into a folder, ``analysis.json`` first; return the paths."""
    paths = [write_text(json.dumps(numbers(found), indent=2) + "\n", folder / "analysis.json")]
    for name, table in tables(found).items():
        path = placeable(folder / f"{name}.csv")
        with whole(path) as part:
            with_units(table).to_csv(part, float_format="%.12g")
        paths.append(path)
    return paths


def export(found: Analysis, path: str | Path) -> list[Path]:
    """Write all tables for another program: CSV, Parquet or MATLAB; return the paths.

    Parameters
    ----------
    found : Analysis
        From `stiction.analyse`.
    path : str or Path
        With .csv or .parquet, the cycles go there and the other tables beside it
        (``test-creep.csv``). With .mat, one file holds a struct for each table. Units are given
        as by `stiction.export`.

    Raises
    ------
    ResultError
        As of `stiction.export`.
    """
    named = {"cycles": found.cycles, **tables(found)}
    return write_tables(named, path, {"kind_of_motion": found.regime.kind})
