"""Creep before slip, its divergence and the misalignment that it implies."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING, Any

import numpy as np

from stiction.analysis.creep.conditions import after_rest, shows_drive
from stiction.analysis.creep.curve import mean_creep
from stiction.analysis.creep.findings import drive_speed
from stiction.analysis.creep.first_slip import slips
from stiction.analysis.creep.misalignment import REST_SPEED
from stiction.analysis.motion.regime.kinds import STUCK
from stiction.analysis.rotation.findings import BOTH, TURNING
from stiction.analysis.signals.correlated_noise import ERRORS_95
from stiction.analysis.signals.robust import without_outliers
from stiction.arrays import xr
from stiction.friction import states
from stiction.storage.table_files import number
from stiction.text.quantity.wording import MEASURABLE, SLIGHT, in_words, times, with_error
from stiction.text.sections import Section
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    from stiction.analysis.creep.misalignment import Misalignment
    from stiction.analysis.report import Analysis

RESTING, UNKNOWN = "it rests", "its creep is not determined"
# By `REST_SPEED`: a law with states never rests
BARELY = "it creeps at less than a millionth of the drive's velocity"
USUAL = 0.5  # of the stick phases: what only the longest of them reach is left to the table
RAPID = 0.5  # of the drive's velocity: a mass so fast does not creep, it gains speed
FAR_STIFFER = " This supposes a spring across the force that is far stiffer, k_x/k_y ≪ tan² φ."
# of the numbers of a fit; others have none
UNITS = {
    "phi": "rad", "F_0": "N", "stiffness": "N/m",
    "amplitude": "m/s", "lag": "s", "loading_time": "s",
}  # fmt: skip
EXCLUDED = 9.0  # sum of squares, in standard errors, by which presliding alone fits worse


def _below_peak(found: Analysis, its: Misalignment) -> str:
    """Return a doubt on F_0 where the spring force exceeds it, which no rotation allows."""
    force = found.record.force / found.record.relative_load()
    peak = float(without_outliers(force[np.isfinite(force)]).max())
    if peak <= its.F_0 + ERRORS_95 * its.F_0_error:
        return ""
    return (
        f" That is too small: the force itself reaches {in_words(peak, 'N')}{_at_load(found)}. "
        "Near slip the creep "
        "is not that of Eq. (7), and the error of F_0 is larger than stated."
    )


def _at_load(found: Analysis) -> str:
    """Return the load that a friction force belongs to, where the load varies, in words."""
    if found.record.load is None or found.record.normal_load is None:
        return ""
    return f" at a normal load of {in_words(found.record.normal_load, 'N')}"


def section(found: Analysis) -> Section:
    """Return the section on creep before slip."""
    if found.creep is None:
        why = found.missing["creep"]
        said = why if why.startswith("not determined") else f"not seen: {why}"
        return Section("Creep", [f"{said[0].upper()}{said[1:]}."])
    creep, waits = _mean_after_rest(found)
    counts = creep["phases"].values
    usual = _usual(creep)
    far, near = (creep.isel(bin=at) for at in (usual, 0))
    long, short = (in_words(float(row["begin"]), "s", 2) for row in (far, near))
    V = drive_speed(found.source, found.record) or 0.0
    lasts = found.record.duration
    rests = RESTING
    if isinstance(found.source, Trajectory) and states(found.source.slider.law):
        rests = BARELY
    first, last = _creeping(far, V, lasts, rests), _creeping(near, V, lasts, rests)
    number = counts[0] if found.curves is None else found.curves.sizes["phase"]
    several = f" {_phases(*map(int, (*counts[[usual, 0]], number)))}" if counts[0] > 1 else ""
    lines = [
        f"{long} before {end_of_creep(found)} {first}{waits}; in the last {short} {last}.{several}"
    ]
    if first == last == rests and found.regime.kind == STUCK:
        return Section("Creep", [f"None: {rests} from beginning to end."])
    if first == last == UNKNOWN:
        lines = [f"{UNKNOWN.capitalize()}.{several}"]
    if found.curves is not None and (left_out := found.curves.attrs.get("left_out", 0)):
        said = "1 stick phase, in which" if left_out == 1 else f"{left_out} stick phases, in which"
        what = "the force hesitates, as where the drive pauses"
        if shows_drive(found.record):
            what = "the drive pauses or goes at another velocity"
        lines.append(f"Left out: {said} {what}.")
    d, phi = found.divergence, found.misalignment
    if found.record.position is None and phi is None:
        lines.append("Creep is counted from the even loading in the first half of each rise.")
    if isinstance(found.source, Trajectory) and found.source.slider.misalignment == 0.0:
        lines.append("There is no misalignment, so friction does not turn.")
        if not states(found.source.slider.law):
            lines.append("A motion in the last moments is the slip itself, which begins.")
    if d is not None:
        lines.append(
            "It diverges towards slip with the exponent "
            f"{with_error(d.exponent, d.exponent_error, '1')} (1/2 by Eq. (8), corrected)."
        )
    if phi is not None:
        both = found.record.stiffness_across is not None or isinstance(found.source, Trajectory)
        lines.append(
            f"By Eq. (7){', with both springs,' * both} it implies a misalignment of "
            f"{with_error(phi.phi, phi.phi_error, 'rad')}{_true(found)}, and "
            f"F_0 = {with_error(phi.F_0, phi.F_0_error, 'N')}{_at_load(found)}."
            f"{FAR_STIFFER * (not both)}{_below_peak(found, phi)}{_presliding(found, phi)}"
        )
    fits = {"divergence": "Exponent of its divergence", "misalignment": "Implied misalignment"}
    lines += [
        f"{what}: {found.missing[fit]}." for fit, what in fits.items() if fit in found.missing
    ]
    return Section("Creep", lines)


def _usual(creep: xr.Dataset) -> int:
    """Return the farthest bin from slip that half of the stick phases reach."""
    counts = creep["phases"].values
    return int(np.flatnonzero(counts >= USUAL * counts[0])[-1])


def _mean_after_rest(found: Analysis) -> tuple[xr.Dataset, str]:
    """Return the mean creep without bins of rest before it, and words on that; all if none is left.

    A bin in which some phases rest still, or begin to creep, has the velocity of neither.
    """
    creep = found.creep
    assert creep is not None
    if found.curves is None:
        return creep, ""
    creeping = after_rest(found.curves, found.source)
    if creeping is found.curves or not np.isfinite(creeping["velocity"].values).any():
        return creep, ""
    its, far = mean_creep(creeping), creep.isel(bin=_usual(creep))
    V = drive_speed(found.source, found.record) or 0.0
    if not float(its["begin"][_usual(its)]) < float(far["begin"]) or _rests(far, V):
        return creep, ""
    rests = "at rest" if isinstance(found.source, Trajectory) else "at rest, or nearly so"
    return its, f", after having been {rests}"


def _presliding(found: Analysis, its: Misalignment) -> str:
    """Return the effect of presliding on the angle of a record, which its errors exclude."""
    if isinstance(found.source, Trajectory) and not states(found.source.slider.law):
        return ""
    shown = found.parts["rotation"]
    if shown is not None and shown.kind == TURNING:
        return " The force across turns, as this supposes (see Rotation of the force)."
    if shown is not None and shown.kind == BOTH:
        return (
            " The force across does not only turn, as this supposes, it grows as well (see "
            "Rotation of the force); the errors do not include that."
        )
    supposed = " It is supposed that the contact does not give way before it slips (presliding)"
    if not np.isfinite(its.worse):
        return f"{supposed}; the errors do not include that."
    if its.worse > EXCLUDED:
        return f"{supposed}. Alone it would not creep so; what it adds is not in the errors."
    return (
        f"{supposed}. One {times(its.contact)} as stiff as the spring would creep so without "
        "any misalignment; the errors do not include that."
    )


def _true(found: Analysis) -> str:
    """Return the true misalignment of a run, for comparison, in words."""
    if not isinstance(found.source, Trajectory):
        return ""
    return f" (the run has {degrees(abs(found.source.slider.misalignment)):.3g} deg)"


def end_of_creep(found: Analysis) -> str:
    """Return the event that ends the stick phases, in words."""
    last = np.inf if found.curves is None else float(found.curves["slip_time"][-1])
    if found.regime.kind == STUCK or (found.curves is not None and last >= found.record.time[-1]):
        return "the end"
    if found.curves is not None and found.curves.sizes["phase"] > 1:
        return "slip"
    if isinstance(found.source, Trajectory):
        slides = not slips(found.source)
    else:
        slides = not found.cycles.sizes["cycle"] and found.friction.break_away is None
    return "the spring is loaded" if slides else "slip"  # it comes to slide without a slip


def _phases(far: int, near: int, number: int) -> str:
    """Return over how many of a number of stick phases two means are, in words."""
    if far == near:
        return f"These are means over {near} stick phases."
    every = f"all {near}" if near == number else f"{near} of {number}"
    if far == 1:
        return f"The first is of the one stick phase so long, the second a mean over {every}."
    if far > near:
        return f"These are means over {far} and {near} of {number} stick phases."
    return f"These are means over the {far} stick phases that are so long, and over {every}."


def _rests(row: xr.Dataset, V: float) -> bool:
    """Return whether creep in a bin is none beside the drive's velocity."""
    value, error = float(row["velocity"]), float(row["velocity_error"])
    return bool(abs(value) + ERRORS_95 * np.nan_to_num(error) < REST_SPEED * V)


def _creeping(row: xr.Dataset, V: float, lasts: float, rests: str) -> str:
    """Return the creep velocity in a bin in words, with its error if not negligible.

    Creep over no measurable distance while the record lasts is none: then it `rests`, in words.
    """
    value, error = float(row["velocity"]), float(row["velocity_error"])
    if _rests(row, V):
        return rests
    if value <= ERRORS_95 * error:
        most = max(value, 0.0) + ERRORS_95 * error
        if most * lasts < MEASURABLE:
            return rests
        if most > V > 0.0:  # the mass is faster than the drive in slips alone
            return UNKNOWN
        return f"it creeps no faster than {in_words(most, 'm/s', 2)} (two standard errors)"
    known = with_error(value, error if error > SLIGHT * abs(value) else 0.0, "m/s")
    return f"it {'moves' if value > RAPID * V > 0.0 else 'creeps'} at {known}"


def tables(found: Analysis) -> dict[str, xr.Dataset | None]:
    """Return the mean creep, and the creep of each stick phase."""
    return {"creep": found.creep, "creep-phases": found.curves}


def numbers(found: Analysis) -> dict[str, Any]:
    """Return the fits to the creep, with units."""
    fits = {"divergence": found.divergence, "misalignment": found.misalignment}
    return {
        name: fit
        and {key: number(value) for key, value in fit._asdict().items()}
        | {"units": {key: UNITS.get(key.removesuffix("_error"), "1") for key in fit._fields}}
        for name, fit in fits.items()
    }
