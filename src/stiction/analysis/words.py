"""An analysis in words and tables."""

from __future__ import annotations

from math import degrees, isfinite
from typing import TYPE_CHECKING

import numpy as np

from stiction.analysis.report import Analysis
from stiction.sections import Section, Table
from stiction.units import in_words

if TYPE_CHECKING:
    import xarray as xr

SHOWN = 8  # cycles in the terminal; files hold all
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
SURE = 2.0  # standard errors that a fit must be away from nothing


def sections(found: Analysis) -> list[Section]:
    """Return the analysis, part by part."""
    kind = str(found.regime)
    return [
        Section("Motion", [f"{kind[0].upper()}{kind[1:]}."]),
        cycles(found),
        creep(found),
        song(found),
        energy(found),
    ]


def cycles(found: Analysis) -> Section:
    """Return mean and spread over cycles."""
    count = found.cycles.sizes["cycle"]
    if not count:
        return Section("Cycles", ["None."])
    rows = []
    for quantity in found.summary["quantity"].values:
        row = found.summary.sel(quantity=quantity)
        mean, spread = float(row["mean"]), float(row["standard_deviation"])
        unit = str(row["unit"].values)
        if isfinite(mean):
            several = in_words(spread, unit) if isfinite(spread) else ""
            rows.append((str(row["meaning"].values), in_words(mean, unit), several))
    table = Table(("quantity", "mean", "standard deviation"), rows)
    return Section("Cycles", [f"{count}, from trough to trough. Means over them:"], table)


def each_cycle(table: xr.Dataset) -> Table:
    """Return the first cycles, a row each."""
    known = [name for name in COLUMNS if np.isfinite(table[name].values).any()]
    rows = [
        (
            str(int(table["cycle"][at])),
            *(in_words(float(table[name][at]), table[name].attrs["units"]) for name in known),
        )
        for at in range(min(table.sizes["cycle"], SHOWN))
    ]
    return Table(("cycle", *(COLUMNS[name] for name in known)), rows)


def creep(found: Analysis) -> Section:
    """Return how it creeps before slip."""
    if found.creep is None:
        return Section("Creep", [f"Not seen: {found.missing['creep']}."])
    far, near = (found.creep.isel(bin=at) for at in (-1, 0))
    long, short = (in_words(float(row["begin"]), "s") for row in (far, near))
    phases = int(found.creep["phases"].max())
    lines = [
        f"From {_measured(far, 'velocity', 'm/s')} at {long} before slip to "
        f"{_measured(near, 'velocity', 'm/s')} in the last {short}; "
        f"{phases} stick phase{'s' * (phases != 1)}."
    ]
    if found.record.position is None:
        lines.append("Counted from the even loading in the first half of each rise.")
    d, phi = found.divergence, found.misalignment
    if d is not None and d.amplitude > SURE * d.amplitude_error and d.exponent > 0.0:
        lines.append(
            f"It diverges towards slip with the exponent {d.exponent:.3f} ± {d.exponent_error:.3f} "
            "(1/2 by Eq. (8), corrected)."
        )
    elif d is not None:
        lines.append("No divergence towards slip stands out of its uncertainty.")
    if phi is not None and abs(phi.phi) > SURE * phi.phi_error:
        angle, error = degrees(phi.phi), degrees(phi.phi_error)
        lines.append(
            f"By Eq. (7) it implies a misalignment of {angle:.3g} ± {error:.1g} deg, and "
            f"F_0 = {in_words(phi.F_0, 'N')}."
        )
    elif phi is not None:
        lines.append("No misalignment that it implies stands out of its uncertainty.")
    fits = {"divergence": "No exponent", "misalignment": "No implied misalignment"}
    lines += [
        f"{what}: {found.missing[fit]}." for fit, what in fits.items() if fit in found.missing
    ]
    return Section("Creep", lines)


def song(found: Analysis) -> Section:
    """Return what it sings, and when."""
    if found.song is None:
        return Section("Song", [f"Not heard: {found.missing['song']}."])
    heard = found.song["frequency"].values
    heard = heard[np.isfinite(heard)]
    if not len(heard):
        return Section("Song", ["No line stands out of the noise."])
    lines = [
        f"Heard in {len(heard) / found.song.sizes['time']:.0%} of the time, between "
        f"{in_words(heard.min(), 'Hz')} and {in_words(heard.max(), 'Hz')}."
    ]
    if found.phases is None:
        return Section("Song", lines)
    natural = found.song.attrs["natural_frequency"]
    lines[0] += f" The transverse natural frequency is {in_words(natural, 'Hz')}."
    names = ("share_stuck", "sticks_per_second", "ring_down", "first_frequency", "last_frequency")
    units = ("%", "1/s", "%", "Hz", "Hz")
    rows = [
        (
            in_words(float(found.phases["start"][at]), "s"),
            *(
                f"{100.0 * float(found.phases[name][at]):.3g} %"
                if unit == "%"
                else in_words(float(found.phases[name][at]), unit)
                for name, unit in zip(names, units, strict=True)
            ),
        )
        for at in range(min(found.phases.sizes["phase"], SHOWN))
    ]
    heads = ("stick phase from", "at rest", "sticks", "ringing down", "song from", "to")
    return Section("Song", lines, Table(heads, rows))


def energy(found: Analysis) -> Section:
    """Return where the work of the drive goes."""
    if found.energy is None:
        return Section("Energy", [f"Not known: {found.missing['energy']}."])
    every = ("work", "friction_x", "friction_y", "damper_x", "damper_y", "spring_x", "kinetic")
    names = [name for name in every if found.energy[name].values.any()]
    rows = [
        (
            in_words(float(found.energy["start"][at]), "s"),
            *(in_words(float(found.energy[name][at]), "J") for name in names),
        )
        for at in range(min(found.energy.sizes["interval"], SHOWN))
    ]
    work, left = (float(np.abs(found.energy[name]).sum()) for name in ("work", "residual"))
    heads = ("from", *(name.replace("_", " along ") for name in names))
    closes = f"It closes to {left / work:.1g} of the work." if work > 0.0 else "No work is done."
    sentence = f"Where the work of the drive goes, from each time to the next. {closes}"
    return Section("Energy", [sentence], Table(heads, rows))


def _measured(row: xr.Dataset, name: str, unit: str) -> str:
    value, error = float(row[name]), float(row[f"{name}_error"])
    spread = f" ± {in_words(error, unit)}" if isfinite(error) and error > 0.0 else ""
    return in_words(value, unit) + spread
