"""An audit in words and tables, for any page or terminal."""

from __future__ import annotations

from math import degrees, isfinite, nan

import numpy as np

from stiction.analysis.creep import first_slip_time
from stiction.analysis.regime import STICK_SLIP
from stiction.audit.advice import Advice
from stiction.audit.report import Audit
from stiction.sections import Section, Table
from stiction.units import in_words

NAMES = {
    "phi": "misalignment φ",
    "drive.velocity": "drive velocity V",
    "c_x": "damping c_x",
    "k_x": "stiffness k_x",
}


def sections(found: Audit) -> list[Section]:
    """Return the report, part by part."""
    return [
        Section("Verdict", verdict(found)),
        Section("Predicted and simulated", [], numbers(found)),
        Section("Is it stick?", stick(found)),
        Section("Song", song(found)),
        Section("What to change", *changes(found)),
    ]


def verdict(found: Audit) -> list[str]:
    """Return what the apparatus will do, and how far it is from doing otherwise."""
    seen, growth = found.observation, found.sliding.growth_rate
    if not seen.run.status.ok:
        return [f"The simulation ended early: {seen.run.status.value}."]
    lines = [f"In the simulated test the load cell sees {seen.regime}."]
    if found.sliding.stable:
        lines.append(f"Steady sliding is stable: disturbances decay at {-growth:.4g} per second.")
    else:
        frequency = float(found.sliding.frequencies[0])
        swing = f", swinging at {in_words(frequency, 'Hz')}" if frequency > 0.0 else ""
        lines.append(
            f"Steady sliding is unstable: disturbances grow by e in {in_words(1 / growth, 's')}"
            f"{swing}."
            if growth > 0.0
            else "Steady sliding is on the border of stability."
        )
    return [*lines, margin(found)]


def margin(found: Audit) -> str:
    """Return where phi stands beside its critical values."""
    phi, values = found.slider.phi, found.misalignment.values
    if not len(values):
        always = "stable" if all(found.misalignment.stable) else "unstable"
        return f"No misalignment changes that: it is {always} at every φ of that sign."
    nearest = float(values[np.argmin(np.abs(values - phi))])
    closed = found.prediction.phi_c
    lowest = abs(nearest) == np.min(np.abs(values))
    form = f" ({degrees(closed):.4f} deg in closed form)" if lowest and isfinite(closed) else ""
    way = "more" if abs(nearest) > abs(phi) else "less"
    return (
        f"That changes at φ_c = {degrees(nearest):.4f} deg{form}: the margin is "
        f"{abs(degrees(nearest - phi)):.4g} deg {way} misalignment than now, "
        f"{degrees(phi):.4g} deg."
    )


def numbers(found: Audit) -> Table:
    """Return predicted quantities beside what the simulation shows."""
    p, seen, s = found.prediction, found.observation, found.slider
    first = seen.run.sticks[0, 1] - seen.run.sticks[0, 0] if len(seen.run.sticks) else 0.0
    slip = first_slip_time(seen.run)
    slip = slip if slip < seen.record.time[-1] else nan
    rows = [
        ("friction at vanishing slip F_0", p.F_0, None, "N"),
        ("natural frequency along x", p.f_x, None, "Hz"),
        ("natural frequency along y", p.f_y, None, "Hz"),
        ("damping number A, Eq. (10)", p.A, None, ""),
        ("damping ratio ζ at θ = φ, Eq. (10)", p.zeta, None, ""),
        ("θ at which ζ = 1: slow slip turns fast", p.theta_c, None, "rad"),
        ("first stick: true rest", p.first_stick, first, "s"),
        ("time until the first slip, Eq. (7)", p.load_up if p.zeta < 1.0 else nan, slip, "s"),
        ("creep velocity at first, V sin² φ", p.creep_at_start, None, "m/s"),
        ("creep velocity when it slips, Eq. (7)", p.creep_at_slip, None, "m/s"),
        ("creep before slip", p.creep_distance, seen.mean("creep_distance"), "m"),
        ("apparent static friction", p.mu_static, peak(found), ""),
        ("apparent kinetic friction", p.mu_kinetic, seen.mean("mu_kinetic"), ""),
        ("force drop", p.drop, seen.mean("drop"), "N"),
        ("period", p.period, seen.mean("period"), "s"),
        ("apparent stiffness", s.k_x, seen.mean("stiffness"), "N/m"),
    ]
    lines = [
        (name, in_words(theory, unit), "" if shown is None else in_words(shown, unit))
        for name, theory, shown, unit in rows
    ]
    return Table(("quantity", "theory", "simulated"), lines)


def peak(found: Audit) -> float:
    """Return what would be read as the coefficient of static friction."""
    largest = float(np.max(found.observation.record.force, initial=0.0))
    return largest / found.slider.normal_load


def stick(found: Audit) -> list[str]:
    """Return which part of what looks like stick is none."""
    seen, s = found.observation, found.slider
    rest, creep, slip = (f"{100.0 * share:.3g} %" for share in seen.shares)
    whole = "of each cycle" if seen.cycles.sizes["cycle"] else "of the time until it slides"
    lines = [
        f"Moving slower than the drive, which a load cell shows as a rising force, takes "
        f"{100.0 * (seen.shares.rest + seen.shares.creep):.3g} % {whole}: at rest {rest}, "
        f"creeping {creep}. Slipping faster than the drive takes {slip}."
    ]
    if s.phi == 0.0:
        return [*lines, "There is no misalignment: nothing turns, and what sticks is at rest."]
    if seen.shares.creep > seen.shares.rest:
        distance = seen.mean("creep_distance")
        far = in_words(distance if isfinite(distance) else found.prediction.creep_distance, "m")
        lines.append(
            f"What looks like stick is mostly creep under a friction force that turns: an artefact "
            f"of the misalignment. The mass covers {far} before it slips, from "
            f"{in_words(found.prediction.creep_at_start, 'm/s')} on. The largest force says how "
            f"friction turned, not that the interface has static friction."
        )
    if seen.regime.kind == STICK_SLIP:
        lines.append(
            "The kinetic coefficient is the mean of peak and trough; the trough is where the mass "
            "swings to, and no property of the interface either."
        )
    return lines


def song(found: Audit) -> list[str]:
    """Return what the rig sings at, and what it takes to see it."""
    p, seen = found.prediction, found.observation
    if p.amplitude == 0.0:
        return ["Without misalignment the transverse spring is not excited."]
    force = in_words(p.amplitude * found.slider.k_y, "N")
    lines = [
        f"The transverse spring swings at {in_words(p.f_y, 'Hz')}, or lower as slip approaches, by "
        f"{in_words(p.amplitude, 'm')} at most (V sin φ/ω_y), {force} of transverse force. Sample "
        f"at {in_words(p.sample_rate, 'Hz')} to see it; above {in_words(2.0 * p.f_y, 'Hz')} it is "
        f"not mistaken for another frequency."
    ]
    if seen.coarse:
        rate = in_words(seen.record.sample_rate, "Hz")
        lines.append(f"So long a test was simulated with {rate}, which does not show it.")
    return lines


def changes(found: Audit) -> tuple[list[str], Table | None]:
    """Return what would make it slide steadily, each with its simulation."""
    if found.sliding.stable:
        return ["Nothing: it slides steadily once it has settled."], None
    rows = [_change(found, advice) for advice in found.advices]
    return [
        "To slide steadily, one of these; each was simulated, and the last column says what the "
        "load cell shows then."
    ], Table(("change", "now", "stable from", "tried", "simulated: force drop, motion"), rows)


def _change(found: Audit, advice: Advice) -> tuple[str, ...]:
    name, now = NAMES[advice.path], in_words(advice.now, advice.unit)
    if advice.tried is None:
        low, high = (in_words(end, advice.unit) for end in advice.between)
        return name, now, "nowhere", f"{low} to {high}", "no value makes sliding steady"
    edge, then = in_words(advice.critical, advice.unit), in_words(advice.then, advice.unit)
    before, after = found.observation.mean("drop"), advice.tried.mean("drop")
    fall = f"{in_words(before, 'N')} → {in_words(after, 'N')}"
    regime = advice.tried.regime
    kind = regime.kind if advice.works else f"no remedy: {regime.kind}"
    return name, now, edge, then, f"{fall}; {kind} ({regime.confidence:.2f})"
