"""The report of an analysis in words and tables."""

from __future__ import annotations

from math import degrees, isfinite
from typing import TYPE_CHECKING

import numpy as np

from stiction.analysis.creep.findings import RESTS, drive_speed
from stiction.analysis.motion.friction import Measured
from stiction.analysis.motion.regime import (
    COUPLED,
    HARMONIC,
    IRREGULAR,
    SETTLING,
    STEADY,
    STICK_SLIP,
    STUCK,
    TRANSITIONAL,
)
from stiction.analysis.oscillation import hides
from stiction.analysis.signals.hum import of_mains
from stiction.analysis.slip import stuck_until
from stiction.text.columns import Quantity, grid
from stiction.text.sections import Section, Table
from stiction.text.units import in_words
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    import xarray as xr

    from stiction.analysis.report import Analysis

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
UNLESS_NONE = ("hesitations",)
SELDOM = 0.05  # of the time: a line that is seen no longer may be chance
NOTHING = 1e-3  # of the work: what is less stands in the files, not in the terminal
ALIKE = 1e-5  # of a value: a spread that is less is the solver's, not the motion's
FRICTIONS = {
    "break_away": "first break-away",
    "static": "static, mean of the peaks",
    "kinetic": "kinetic, mean while it slides",
}
SLIGHT = 1e-3  # of a velocity: an error that is less is not worth a word
RESTING = "it rests"
SURE = 2.0  # standard errors that a fit must be away from nothing


def sections(found: Analysis) -> list[Section]:
    """Return the parts of the report: warnings, a plain sentence, then the details."""
    kind = str(found.regime)
    doubts = [Section("Warnings", list(found.warnings))] if found.warnings else []
    return [
        *doubts,
        Section("Motion", [plainly(found), f"{kind[0].upper()}{kind[1:]}."]),
        friction(found),
        cycles(found),
        creep(found),
        oscillation(found),
        energy(found),
    ]


def plainly(found: Analysis) -> str:
    """Describe the motion in a sentence that needs no theory."""
    count, kind = found.cycles.sizes["cycle"], found.regime.kind
    if count:
        drop, period = (float(found.cycles[name].mean()) for name in ("drop", "period"))
        times = "once" if count == 1 else f"{count} times"
        every = f", every {in_words(period, 's')}" if count > 1 else ""
        size = f"the force drops by {in_words(drop, 'N')}"
        plain = {
            STICK_SLIP: f"The mass sticks and slips {times}{every}; {size}",
            TRANSITIONAL: f"The mass slips {times}{every}, between stick-slip and plain "
            f"vibration; {size}",
            HARMONIC: f"The mass swings {times}{every}{_stuck(found)}; {size}",
        }
        if kind in plain:
            each = " each time" if count > 1 else ""
            return f"{plain[kind]}{each}.{_quick(found, period)}"
    if found.regime.evidence.get("backward", 0.0) > 0.5:
        return (
            "The force falls slowly and rises fast: it is recorded with the other sign, in all "
            "likelihood. Analyse it with force=-force."
        )
    slides = found.friction.kinetic
    at = f", at a force of {in_words(slides.force, 'N')}" if slides is not None else ""
    plain = {
        STEADY: f"The mass slides steadily{at}.",
        SETTLING: f"The motion dies down, and the mass comes to slide steadily{at}.",
        STUCK: "The mass sticks for the whole record: the force only rises.",
        IRREGULAR: "The mass vibrates irregularly.",
    }
    return plain.get(kind, "This record does not show what the mass does.")


def _stuck(found: Analysis) -> str:
    """Return how long a run sticks in its cycles, in words; '' for a record."""
    run, ends = found.source, found.cycles
    if not isinstance(run, Trajectory):
        return ""
    time = np.array([ends["start"].values[0], ends["trough_time"].values[-1]])
    share = float(np.diff(stuck_until(time, run.stick_intervals))[0] / np.diff(time)[0])
    return f", and sticks for {100.0 * share:.2g}% of that time" if share else ", without sticking"


def _quick(found: Analysis, period: float) -> str:
    """Note that the cycles of a run are too fast for the softer spring alone."""
    if not isinstance(found.source, Trajectory) or found.regime.kind == STICK_SLIP:
        return ""
    own = 1.0 / found.source.slider.natural_frequencies[0]
    if period >= COUPLED * own:
        return ""
    return (
        f" That is quicker than the {in_words(own, 's')} in which it swings on the softer spring "
        "alone: the stiffer one swings as well (a study calls this transverse oscillation)."
    )


def friction(found: Analysis) -> Section:
    """Return the friction at the break-away, at rest and while it slides."""
    rows, lines = [], []
    for name, title in FRICTIONS.items():
        each: Measured | None = getattr(found.friction, name)
        if each is None:
            lines.append(
                f"{title[0].upper()}{title[1:]}: not known; {found.friction.missing[name]}."
            )
            continue
        error = each.error if each.error > ALIKE * abs(each.force) else 0.0
        force = _with_error(in_words(each.force, "N"), error, "N")
        spread = _spread(each.spread, each.force, "N")
        mu = f"{each.coefficient:.4g}" if isfinite(each.coefficient) else ""
        if mu and each.coefficient_error > SLIGHT * abs(each.coefficient):
            mu += f" ± {each.coefficient_error:.1g}"
        rows.append((title, mu, force, spread))
    if not rows:
        return Section("Friction", lines)
    if not isinstance(found.source, Trajectory) and found.record.zero is None:
        lines.append("The zero of the force is assumed: no reading without load is given.")
    return Section("Friction", lines, Table(("friction", "µ", "force", "spread"), rows))


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
        if isfinite(mean) and (quantity not in UNLESS_NONE or mean):
            several = _spread(spread, mean, unit)
            rows.append((str(row["meaning"].values), in_words(mean, unit), several))
    table = Table(("quantity", "mean", "standard deviation"), rows)
    lines = [*_hesitations(found.cycles), f"{count}, from trough to trough. Means over them:"]
    left_out = [name for name in COLUMNS if name in found.missing]
    if left_out:
        columns = ", ".join(COLUMNS[name] for name in left_out)
        lines.append(f"Not given: {columns}; {found.missing[left_out[0]]}.")
    return Section("Cycles", lines, table)


def _hesitations(table: xr.Dataset) -> list[str]:
    """Return the frequency and size of hesitations, and their detection limit, in words."""
    some = int((table["hesitations"] > 0).sum())
    if not some:
        return []
    depth = table["hesitation_depth"]
    most, least = 100.0 * float((depth / table["drop"]).max()), float(depth.attrs["least"])
    cycles = f"{some} of {table.sizes['cycle']} cycles"
    return [
        f"In {cycles} the force hesitates: before or within its fall "
        f"it turns back by up to {most:.2g}% of that fall. What turns back by less than "
        f"{in_words(least, 'N')} cannot be distinguished from noise and ripple, and is not counted."
    ]


def each_cycle(table: xr.Dataset) -> Table:
    """Return the first cycles, a row each."""
    known = [name for name in COLUMNS if np.isfinite(table[name].values).any()]
    columns = {
        COLUMNS[name]: Quantity(table[name].values, table[name].attrs["units"]) for name in known
    }
    numbers = grid(columns, SHOWN)
    cycle = [str(number) for number in table["cycle"].values]
    rows = [(number, *row) for number, row in zip(cycle, numbers.rows, strict=False)]
    return Table(("cycle", *numbers.headings), rows)


def creep(found: Analysis) -> Section:
    """Return the section on creep before slip."""
    if found.creep is None:
        return Section("Creep", [f"Not seen: {found.missing['creep']}."])
    far, near = (found.creep.isel(bin=at) for at in (-1, 0))
    long, short = (in_words(float(row["begin"]), "s") for row in (far, near))
    phases = int(found.creep["phases"].max())
    V = drive_speed(found.source, found.record) or 0.0
    first, last = _creeping(far, V), _creeping(near, V)
    several = f"{phases} stick phase{'s' * (phases != 1)}"
    lines = [f"At {long} before {_end(found)} {first}, in the last {short} {last}; {several}."]
    if first == last == RESTING and found.regime.kind == STUCK:
        return Section("Creep", ["None: it rests from beginning to end."])
    d, phi = found.divergence, found.misalignment
    if found.record.position is None and phi is None:
        lines.append("Counted from the even loading in the first half of each rise.")
    if isinstance(found.source, Trajectory) and found.source.slider.phi == 0.0:
        lines.append("There is no misalignment, so friction does not turn.")
    if d is not None:
        lines.append(
            f"It diverges towards slip with the exponent {d.exponent:.3f} ± {d.exponent_error:.3f} "
            "(1/2 by Eq. (8), corrected)."
        )
    if phi is not None:
        angle, error = degrees(phi.phi), degrees(phi.phi_error)
        lines.append(
            f"By Eq. (7) it implies a misalignment of {angle:.3g} ± {error:.1g} deg{_true(found)}, "
            f"and F_0 = {in_words(phi.F_0, 'N')}."
        )
    fits = {"divergence": "Exponent of its divergence", "misalignment": "Implied misalignment"}
    lines += [
        f"{what}: {found.missing[fit]}." for fit, what in fits.items() if fit in found.missing
    ]
    return Section("Creep", lines)


def oscillation(found: Analysis) -> Section:
    """Return the section on the fast oscillation."""
    if found.oscillation is None:
        return Section("Oscillation", [f"Not seen: {found.missing['oscillation']}."])
    seen = found.oscillation["frequency"].values
    seen = seen[np.isfinite(seen)]
    if len(seen) < SELDOM * found.oscillation.sizes["time"] or not len(seen):
        return Section("Oscillation", [f"No line stands out of the noise.{_hidden(found)}"])
    low, high = (in_words(float(each), "Hz") for each in (seen.min(), seen.max()))
    share = 100.0 * len(seen) / found.oscillation.sizes["time"]
    pitch = f"between {low} and {high}" if low != high else f"at {low}"
    lines = [f"Seen in {share:.3g}% of the time, {pitch}."]
    if of_mains(float(np.median(seen))):
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
        "free swing at the end": Quantity(100.0 * phases["ring_down"].values, "%"),
        "oscillation from": Quantity(phases["first_frequency"].values, "Hz"),
        "to": Quantity(phases["last_frequency"].values, "Hz"),
    }
    known = {
        name: each
        for name, each in columns.items()
        if np.isfinite(np.asarray(each.values, dtype=np.float64)[:SHOWN]).any()
    }
    lines[0] += _hidden(found)
    return Section("Oscillation", lines, grid(known, SHOWN))


def _hidden(found: Analysis) -> str:
    """Note that cycles follow too closely to be distinguished from an oscillation."""
    oscillation = found.oscillation
    if found.phases is None or oscillation is None or not hides(oscillation, found.cycles):
        return ""
    width = in_words(oscillation.attrs["width"], "s")
    return (
        f" It is sought in windows of 50 of its periods, {width}; the cycles follow too closely "
        "for that, so it is sought before the first only."
    )


def energy(found: Analysis) -> Section:
    """Return the section on energy."""
    if found.energy is None:
        return Section("Energy", [f"Not known: {found.missing['energy']}."])
    budget = found.energy
    work, left = (float(np.abs(budget[name]).sum()) for name in ("work", "residual"))
    names = [name for name in ENERGIES if np.abs(budget[name]).max() > NOTHING * work]
    columns = {"from": Quantity(budget["start"].values, "s")}
    columns |= {ENERGIES[name]: Quantity(budget[name].values, "J") for name in names}
    closes = f"It closes to {left / work:.1g} of the work." if work > 0.0 else "No work is done."
    small = [ENERGIES[name] for name in ENERGIES if name not in names]
    less = f" Less than {100 * NOTHING:g}% of it: {', '.join(small)}." if small and work else ""
    sentence = f"Where the work of the drive goes, from each time to the next. {closes}{less}"
    return Section("Energy", [sentence], grid(columns, SHOWN, alike="J"))


def _with_error(value: str, error: float, unit: str) -> str:
    """Return a value in words with its standard error, if that is known."""
    return f"{value} ± {in_words(float(f'{error:.1g}'), unit)}" if error > 0.0 else value


def _spread(spread: float, mean: float, unit: str) -> str:
    """Return a spread in words, or an upper limit if it is below the accuracy of a run."""
    if not isfinite(spread):
        return ""
    if spread <= ALIKE * abs(mean):
        return f"< {100.0 * ALIKE:g}%"
    return in_words(spread, unit)


def _true(found: Analysis) -> str:
    """Return the true misalignment of a run, for comparison, in words."""
    if not isinstance(found.source, Trajectory):
        return ""
    return f" (the run has {degrees(abs(found.source.slider.phi)):.3g} deg)"


def _end(found: Analysis) -> str:
    """Return the event that ends the stick phases, in words."""
    last = np.inf if found.curves is None else float(found.curves["slip_time"][-1])
    if found.curves is not None and last >= found.record.time[-1]:
        return "the end"
    if not found.cycles.sizes["cycle"] and found.friction.break_away is None:
        return "the spring is loaded"  # it comes to slide without a slip
    return "slip"


def _creeping(row: xr.Dataset, V: float) -> str:
    """Return the creep velocity in a bin in words, with its error if not negligible."""
    value, error = float(row["velocity"]), float(row["velocity_error"])
    if abs(value) + SURE * np.nan_to_num(error) < RESTS * V:
        return RESTING
    if value <= SURE * error:
        most = max(value, 0.0) + SURE * error
        return f"it creeps no faster than {in_words(most, 'm/s')} (two standard errors)"
    spread = f" ± {in_words(error, 'm/s')}" if error > SLIGHT * abs(value) else ""
    return f"it creeps at {in_words(value, 'm/s')}{spread}"
