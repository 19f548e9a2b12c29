"""Where the work of the drive goes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stiction.arrays import xr
from stiction.errors import ResultError
from stiction.text.columns import SHOWN_ROWS, Quantity, grid, rows_left_out
from stiction.text.quantity.wording import in_words, percent
from stiction.text.sections import Section
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis

ENERGIES = {
    "work": "work",
    "friction_x": "friction x",
    "friction_y": "friction y",
    "damper_x": "damper x",
    "damper_y": "damper y",
    "spring_x": "spring x",
    "spring_y": "spring y",
    "kinetic": "kinetic",
}
NOTHING = 1e-3  # of the work: what is less stands in the files, not in the terminal


def find(found: Analysis) -> xr.Dataset:
    """Return the energy budget of each cycle of a run."""
    if not isinstance(found.source, Trajectory):
        raise ResultError(
            "a record lacks the force of friction, and what the dampers take; a run has them"
        )
    from stiction.analysis.energy import energy_budget  # with the solver, which no record needs

    ends, cycles = found.source.samples["time"][[0, -1]], found.cycles
    borders = [ends, cycles["start"].values, cycles["trough_time"].values[-1:]]
    return energy_budget(found.source, np.unique(np.concatenate(borders)))


def section(found: Analysis) -> Section:
    """Return the section on energy."""
    if found.energy is None:
        return Section("Energy", [f"Not known: {found.missing['energy']}."])
    budget = found.energy
    work, left = (float(np.abs(budget[name]).sum()) for name in ("work", "residual"))
    least = NOTHING * np.maximum(np.abs(budget["work"]), NOTHING * work)
    names = [name for name in ENERGIES if (np.abs(budget[name]) > least).any()]
    columns = {"from": Quantity(budget["start"].values, "s")}
    columns |= {ENERGIES[name]: Quantity(budget[name].values, "J") for name in names}
    closes = (
        f"The balance closes to {in_words(left / work, '1', 1)} of the work."
        if left and work
        else "The balance closes exactly."
    )
    closes = closes if work else "No work is done."
    small = [ENERGIES[name] for name in ENERGIES if name not in names]
    less = (
        f" Not shown, because always less than {percent(NOTHING)} of the work: {', '.join(small)}."
        if small and work
        else ""
    )
    sentence = f"The work of the drive, and where it goes, cycle by cycle. {closes}{less}"
    more = rows_left_out(len(budget["start"]), "rows", "energy.csv")
    return Section("Energy", [sentence, *more], grid(columns, SHOWN_ROWS, alike="J"))


def tables(found: Analysis) -> dict[str, xr.Dataset | None]:
    """Return the budget."""
    return {"energy": found.energy}
