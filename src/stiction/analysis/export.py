"""The results of an analysis as files: CSV for each table, JSON for the numbers."""

from __future__ import annotations

import json
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stiction.storage.files import placeable, whole
from stiction.storage.table_files import with_units, write_tables

if TYPE_CHECKING:
    import xarray as xr

    from stiction.analysis.report import Analysis

FRICTIONS = ("break_away", "static", "kinetic")
# of each of them, with its unit
FRICTION = {
    "force": "N",
    "error": "N",
    "spread": "N",
    "coefficient": "1",
    "coefficient_error": "1",
    "coefficient_spread": "1",
}


def tables(found: Analysis) -> dict[str, xr.Dataset]:
    """Return all tables by name."""
    named = {
        "friction": friction_table(found),
        "cycles": found.cycles,
        "summary": found.summary,
        "creep": found.creep,
        "creep-phases": found.curves,
        "oscillation": found.oscillation,
        "oscillation-phases": found.phases,
        "energy": found.energy,
    }
    return {name: table for name, table in named.items() if table is not None}


def friction_table(found: Analysis) -> xr.Dataset | None:
    """Return the known kinds of friction, a row each; None if there is none."""
    import xarray as xr

    known = {name: each for name in FRICTIONS if (each := getattr(found.friction, name))}
    if not known:
        return None
    columns = {
        key: ("friction", [getattr(each, key) for each in known.values()], {"units": unit})
        for key, unit in FRICTION.items()
    }
    return xr.Dataset(columns, {"friction": ("friction", list(known))})


def write(found: Analysis, folder: Path) -> list[Path]:
    """Write all tables into a folder, ``analysis.json`` first; return the paths."""
    paths = [placeable(folder / "analysis.json")]
    with whole(paths[0]) as part:
        part.write_text(json.dumps(numbers(found), indent=2) + "\n", encoding="utf-8")
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


def numbers(found: Analysis) -> dict[str, Any]:
    """Return the numbers of an analysis, in SI and rad, for JSON; null for unknown ones."""
    mean = {
        str(row): {
            "mean": _number(found.summary["mean"].sel(quantity=row)),
            "standard_deviation": _number(found.summary["standard_deviation"].sel(quantity=row)),
            "number": int(found.summary["number"].sel(quantity=row)),
            "unit": str(found.summary["unit"].sel(quantity=row).values),
        }
        for row in found.summary["quantity"].values
    }
    fits = {"divergence": found.divergence, "misalignment": found.misalignment}
    return {
        "regime": {
            "kind": found.regime.kind,
            "confidence": _number(found.regime.confidence),
            "runner_up": found.regime.runner_up or None,
            "evidence": {name: _number(value) for name, value in found.regime.evidence.items()},
        },
        "cycles": mean,
        **{
            name: None if fit is None else {key: _number(v) for key, v in fit._asdict().items()}
            for name, fit in fits.items()
        },
        "friction": _friction(found),
        "warnings": list(found.warnings),
        "missing": found.missing,
    }


def _friction(found: Analysis) -> dict[str, Any]:
    """Return each friction as a table: force, coefficient, error and spread, or the reason."""
    shown: dict[str, Any] = {}
    for name in FRICTIONS:
        each = getattr(found.friction, name)
        if each is None:
            shown[name] = None
            continue
        values = {key: getattr(each, key) for key in FRICTION}
        shown[name] = {key: _number(value) for key, value in values.items()}
    return shown | {"missing": found.friction.missing}


def _number(value: Any) -> float | None:
    return float(value) if isfinite(float(value)) else None
