"""The fast oscillation."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stiction.analysis.oscillation import hides, stands_out
from stiction.analysis.signals.hum import of_mains
from stiction.arrays import xr
from stiction.text.columns import SHOWN_ROWS, Quantity, grid, rows_left_out
from stiction.text.quantity.wording import in_words, percent
from stiction.text.sections import Section
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis


def section(found: Analysis) -> Section:
    """Return the section on the fast oscillation."""
    if found.oscillation is None:
        return Section("Oscillation", [f"Not seen: {found.missing['oscillation']}."])
    if not stands_out(found.oscillation):
        return Section("Oscillation", [f"No oscillation stands out.{_note_hidden_cycles(found)}"])
    seen = found.oscillation["frequency"].values
    seen = seen[np.isfinite(seen)]
    low, high = (in_words(float(each), "Hz") for each in (seen.min(), seen.max()))
    share = percent(len(seen) / found.oscillation.sizes["time"])
    pitch = f"between {low} and {high}" if low != high else f"at {low}"
    if "frequency_error" in found.oscillation:
        error = float(np.nanmax(found.oscillation["frequency_error"].values))
        pitch += f", each ± {in_words(error, 'Hz', 1)}"
    lines = [f"Seen in {share} of the time, {pitch}."]
    if not isinstance(found.source, Trajectory) and of_mains(float(np.median(seen))):
        lines[0] += " That is the frequency of the mains, or twice it: it is probably hum."
    if found.phases is None:
        return Section("Oscillation", lines)
    natural = found.oscillation.attrs["natural_frequency"]
    lines[0] += f" The transverse natural frequency is {in_words(natural, 'Hz')}."
    phases = found.phases
    columns = {
        "stick phase from": Quantity(phases["start"].values, "s"),
        "at rest": Quantity(100.0 * phases["share_stuck"].values, "%"),
        "sticks": Quantity(phases["sticks_per_second"].values, "1/s"),
        "without a stick at the end": Quantity(100.0 * phases["ring_down"].values, "%"),
        "oscillation from": Quantity(phases["first_frequency"].values, "Hz"),
        "to": Quantity(phases["last_frequency"].values, "Hz"),
    }
    known = {
        name: each
        for name, each in columns.items()
        if np.isfinite(np.asarray(each.values, dtype=np.float64)[:SHOWN_ROWS]).any()
    }
    lines[0] += _note_hidden_cycles(found)
    lines += rows_left_out(phases.sizes["phase"], "stick phases", "oscillation-phases.csv")
    return Section("Oscillation", lines, grid(known, SHOWN_ROWS))


def _note_hidden_cycles(found: Analysis) -> str:
    """Note that cycles follow too closely to be distinguished from an oscillation."""
    oscillation = found.oscillation
    if found.phases is None or oscillation is None or not hides(oscillation, found.cycles):
        return ""
    width = in_words(oscillation.attrs["width"], "s")
    return (
        f" It is sought in windows of 50 of its periods, {width}. Cycles follow each other too "
        "closely for that, so that only the time before the first one is searched."
    )


def tables(found: Analysis) -> dict[str, xr.Dataset | None]:
    """Return the oscillation over time, if one stands out, and a row for each stick phase."""
    seen = found.oscillation if stands_out(found.oscillation) else None
    return {"oscillation": seen, "oscillation-phases": found.phases}
