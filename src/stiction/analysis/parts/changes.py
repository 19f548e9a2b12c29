"""The parts of a record with their own period of cycles, or level of the force.

Steps of the velocity of the drive, or of the load, make them.
"""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np

from stiction.analysis.motion.changes.cycles import parts_of
from stiction.analysis.signals.correlated_noise import statistics
from stiction.arrays import Floats, xr
from stiction.storage.table_files import number
from stiction.text.quantity.wording import in_words, with_error
from stiction.text.sections import Section, Table
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis

# columns of each part: unit, meaning; each mean has its standard error
COLUMNS = {
    "period": ("s", "period"),
    "stick_slope": ("N/s", "loading"),
    "velocity": ("m/s", "velocity"),
    "peak": ("N", "peaks"),
    "middle": ("N", "middles"),
    "drop": ("N", "drop"),
}

# of each level of a force without cycles
LEVEL = {
    "begin": "s",
    "end": "s",
    "force": "N",
    "error": "N",
    "coefficient": "1",
    "coefficient_error": "1",
}


def section(found: Analysis) -> Section | None:
    """Return a row for each part; None where there is a single one."""
    parts: xr.Dataset | None = found.parts["changes"]
    if parts is None:
        return None
    if "coefficient" in parts:
        return _section_of_levels(parts)
    names = [name for name in COLUMNS if np.isfinite(parts[name].values).any()]
    rows = []
    for k in range(parts.sizes["part"]):
        row = parts.isel(part=k)
        ends = (in_words(float(row[name]), "s") for name in ("begin", "end"))
        means = (
            with_error(float(row[name]), float(row[f"{name}_error"]), COLUMNS[name][0])
            for name in names
        )
        rows.append((*ends, str(int(row["number"])), *means))
    headings = ("from", "to", "cycles", *(COLUMNS[name][1] for name in names))
    lines = [
        "The period of the cycles changes: each part has means of its own. The velocity is the "
        "rate of loading over the stiffness, that of the drive less that of the creep; static "
        "friction is that of the peaks, kinetic that of the middles between peaks and troughs."
    ]
    return Section("Parts", lines, Table(headings, rows))


def _section_of_levels(parts: xr.Dataset) -> Section:
    """Return a row for each level of a force without cycles."""
    rows = []
    for k in range(parts.sizes["part"]):
        row = {name: float(parts[name][k]) for name in LEVEL}
        mu = with_error(row["coefficient"], row["coefficient_error"], "1")
        force = with_error(row["force"], row["error"], "N")
        known = mu if np.isfinite(row["coefficient"]) else ""
        rows.append((in_words(row["begin"], "s"), in_words(row["end"], "s"), known, force))
    lines = ["The force stays at levels one after the other; its way between them is left out."]
    return Section("Parts", lines, Table(("from", "to", "µ", "force"), rows))


def find(found: Analysis) -> xr.Dataset | None:
    """Return the means over each part of a record, with standard errors; None for one part."""
    cycles = found.cycles
    if found.regime.has("levels"):
        its = found.parts["levels"]
        return xr.Dataset(
            {
                name: ("part", [getattr(each, name) for each in its], {"units": unit})
                for name, unit in LEVEL.items()
            },
            {"part": ("part", np.arange(1, len(its) + 1))},
        )
    if isinstance(found.source, Trajectory) or not found.regime.loads:
        return None
    places = parts_of(cycles["period"].values)
    if len(places) < 2:
        return None
    columns = {name: cycles[name].values for name in ("period", "stick_slope", "peak", "drop")}
    columns["velocity"] = columns["stick_slope"] / (found.record.stiffness or np.nan)
    columns["middle"] = 0.5 * (cycles["peak"].values + cycles["trough"].values)
    rows: dict[str, Any] = {
        "begin": ("part", [float(cycles["start"][part.start]) for part in places], {"units": "s"}),
        "end": (
            "part",
            [float(cycles["trough_time"][part.stop - 1]) for part in places],
            {"units": "s"},
        ),
        "number": ("part", [part.stop - part.start for part in places]),
    }
    for name, (unit, meaning) in COLUMNS.items():
        means = [_mean(columns[name][part]) for part in places]
        attrs = {"units": unit, "long_name": meaning}
        rows[name] = ("part", [mean for mean, _ in means], attrs)
        rows[f"{name}_error"] = ("part", [error for _, error in means], attrs)
    return xr.Dataset(rows, {"part": ("part", np.arange(1, len(places) + 1))})


def _mean(values: Floats) -> tuple[float, float]:
    """Return the mean without the first value, in which the change may lie, and its error.

    Values that are all equal, as of a coarse clock or converter, tell no error.
    """
    mean, error, _ = statistics(values[1:])
    return mean, error or nan


def tables(found: Analysis) -> dict[str, xr.Dataset | None]:
    """Return a row for each part."""
    return {"parts": found.parts["changes"]}


def numbers(found: Analysis) -> dict[str, Any]:
    """Return the means of each part, for JSON."""
    parts: xr.Dataset | None = found.parts["changes"]
    if parts is None:
        return {}
    return {
        "parts": [
            {name: number(row[name]) for name in parts.data_vars}
            for row in (parts.isel(part=k) for k in range(parts.sizes["part"]))
        ]
    }
