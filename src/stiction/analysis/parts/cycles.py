"""The cycles of a motion: their mean and spread, and each of them."""

from __future__ import annotations

from math import floor, inf, isfinite, nan
from typing import TYPE_CHECKING, Any

import numpy as np

from stiction.analysis.motion.cycle_columns import mean_in_words, table_of, with_spread
from stiction.analysis.motion.doubts.creep_distance import hidden_way, way_of_lag
from stiction.analysis.motion.metadata.loading_rate import LOADING_RATE
from stiction.analysis.motion.regime.evidence import TO_AND_FRO
from stiction.arrays import xr
from stiction.storage.table_files import number
from stiction.text.columns import SHOWN_ROWS, Quantity, grid
from stiction.text.quantity.wording import in_words, percent, with_error
from stiction.text.sections import Section, Table

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis

COLUMNS = {
    "start": "start",
    "period": "period",
    "peak": "peak",
    "trough": "trough",
    "drop": "drop",
    "mu_static": "µ static",
    "mu_kinetic": "µ kinetic",
    "creep_distance": "creep",
    "slip_distance": "slip",
}
LATE = 100.0  # of the time of all cycles: four digits do not tell starts so late apart
WAYS, HIDDEN = ("creep_distance", "slip_distance"), 0.1  # a share of them that is worth a word
BY_RATE = ("stick_slope", "stiffness")  # quantities that have the relative error of that rate
COUNTS = ("hesitations",)  # exact; a count of none is not worth a row


def section(found: Analysis) -> Section:
    """Return mean and spread over cycles."""
    count = found.cycles.sizes["cycle"]
    if not count:
        return Section("Cycles", ["None."])
    if turns_with_drive(found):
        return Section("Cycles", ["Not shown: the force turns with the drive, and not by slips."])
    rows, off = [], _error_of_rate(found)
    for quantity in found.summary["quantity"].values:
        row = found.summary.sel(quantity=quantity)
        mean, spread = float(row["mean"]), float(row["standard_deviation"])
        unit = str(row["unit"].values)
        if isfinite(mean) and (quantity not in COUNTS or mean):
            exact = quantity in COUNTS and spread == 0.0
            several = "0" if exact else with_spread(spread, mean, unit)
            shown = mean_in_words(found.summary, quantity)
            if quantity in BY_RATE and isfinite(off):
                shown = with_error(mean, off * mean, unit)
            rows.append((str(row["meaning"].values), shown, several))
    table = Table(("quantity", "mean", "standard deviation"), rows)
    left_out = count - int(found.summary["number"].sel(quantity="period"))
    less = f"; the means leave out {left_out} that stand apart" if left_out else ""
    lines = [
        *_hesitations(found.cycles),
        f"{count} cycle{'s' * (count > 1)}, from trough to trough{less}.",
        *_hidden_ways(found),
    ]
    unknown = [name for name in COLUMNS if name in found.missing]
    for why in dict.fromkeys(found.missing[name] for name in unknown):
        columns = ", ".join(COLUMNS[name] for name in unknown if found.missing[name] == why)
        lines.append(f"Not given: {columns}; {why}.")
    return Section("Cycles", lines, table)


def turns_with_drive(found: Analysis) -> bool:
    """Return whether the swings of a force come from a drive that goes back and forth."""
    return found.regime.has(*TO_AND_FRO)


def _error_of_rate(found: Analysis) -> float:
    """Return the relative error of the rate of loading; NaN if not known, or not of all cycles.

    Drift, ringing and rounding shift the rates of all cycles alike: their scatter does not show it.
    """
    rates = [each for each in found.parts["metadata"] if each.quantity == LOADING_RATE]
    return rates[0].error / rates[0].found if len(rates) == 1 else nan


def _hidden_ways(found: Analysis) -> list[str]:
    """Return how much of the ways noise, samples and a filter hide, if that is worth a word."""
    hidden = hidden_way(found.record)
    lag = way_of_lag(found.record, table_of(found.cycles))
    ways = {name: float(found.cycles[name].mean()) for name in WAYS if name not in found.missing}
    lines = []
    if any(hidden > HIDDEN * way for way in ways.values()):
        lines.append(
            "Noise and the time between samples hide when a slip begins: creep may be up to "
            f"{in_words(hidden, 'm', 2)} longer, and slip as much shorter."
        )
    if lag > HIDDEN * ways.get("creep_distance", inf):
        lines.append(
            "If it is a filter that makes the slips last so long, creep is up to "
            f"{in_words(lag, 'm', 2)} shorter."
        )
    return lines


def _hesitations(table: xr.Dataset) -> list[str]:
    """Return the frequency and size of hesitations, and their detection limit, in words."""
    some = int((table["hesitations"] > 0).sum())
    if not some:
        return []
    depth = table["hesitation_depth"]
    most, least = float((depth / table["drop"]).max()), float(depth.attrs["least"])
    cycles = f"{some} of {table.sizes['cycle']} cycles"
    return [
        f"In {cycles} the force hesitates: before or within its fall it turns back, by up to "
        f"{percent(most)} of that fall. The rise is counted from trough to peak, with such falls "
        f"in it. Smaller hesitations, below {in_words(least, 'N')}, cannot be distinguished from "
        "noise and ripple, and are not counted."
    ]


def each_cycle(table: xr.Dataset) -> Table:
    """Return the first cycles, a row each."""
    known = [name for name in COLUMNS if np.isfinite(table[name].values).any()]
    columns = {
        COLUMNS[name]: Quantity(table[name].values, table[name].attrs["units"]) for name in known
    }
    first, end = float(table["start"][0]), float(table["trough_time"][-1])
    if first > LATE * (end - first):
        since = floor(first)
        late = Quantity(table["start"].values - since, "s")
        columns = {f"start after {since} s": late} | columns
        del columns["start"]
    numbers = grid(columns, SHOWN_ROWS)
    cycle = [str(number) for number in table["cycle"].values]
    rows = [(number, *row) for number, row in zip(cycle, numbers.rows, strict=False)]
    return Table(("cycle", *numbers.headings), rows)


def tables(found: Analysis) -> dict[str, xr.Dataset | None]:
    """Return a row for each cycle, and mean and spread over all; nothing without cycles."""
    if not found.cycles.sizes["cycle"]:
        return {}
    return {"cycles": found.cycles, "summary": found.summary}


def numbers(found: Analysis) -> dict[str, Any]:
    """Return mean and spread of each quantity."""
    rows = (found.summary.sel(quantity=row) for row in found.summary["quantity"].values)
    return {
        "cycles": {
            str(row["quantity"].values): {
                "mean": number(row["mean"]),
                "standard_deviation": number(row["standard_deviation"]),
                "number": int(row["number"]),
                "unit": str(row["unit"].values),
            }
            for row in rows
        }
    }
