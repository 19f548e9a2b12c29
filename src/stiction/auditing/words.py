"""An audit in words and tables, for any page or terminal."""

from __future__ import annotations

from math import degrees, hypot, isfinite, nan, tan

import numpy as np

from stiction.analysis.creep import first_slip_time
from stiction.analysis.regime import SETTLING, STICK_SLIP, STUCK, TRANSITIONAL, UNDETERMINED
from stiction.auditing.advice import Advice
from stiction.auditing.report import Audit
from stiction.friction import has_state
from stiction.sections import Section, Table
from stiction.units import in_words

NAMES = {
    "phi": "misalignment φ",
    "drive.velocity": "drive velocity V",
    "c_x": "damping c_x",
    "k_x": "stiffness k_x",
}


SEEN = {  # kinds of motion, in a sentence
    TRANSITIONAL: f"a {TRANSITIONAL} between stick-slip and harmonic vibration",
    SETTLING: f"a motion {SETTLING} to steady sliding",
    STUCK: "a mass that is stuck",
    UNDETERMINED: "a motion of no clear kind",
}
# of the time until the slip: a first stick that is longer is no short beginning, as in Eq. (7)
SHORT = 0.1


def sections(found: Audit) -> list[Section]:
    """Return the report, part by part."""
    return [
        Section("Verdict", verdict(found)),
        Section("Predicted and simulated", supposed(found), numbers(found)),
        Section("Is it stick?", stick(found)),
        Section("Song", song(found)),
        Section("What to change", *changes(found)),
    ]


def verdict(found: Audit) -> list[str]:
    """Return what the apparatus will do, and how far it is from doing otherwise."""
    seen, growth = found.observation, found.sliding.growth_rate
    if not seen.run.status.ok:
        return [f"The simulation ended early: {seen.run.status.value}."]
    kind = seen.regime.kind
    lines = [
        f"In the simulated test the load cell sees {SEEN.get(kind, kind)}"
        f"{str(seen.regime).removeprefix(kind)}."
    ]
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
    closed = found.prediction.phi_c
    if not len(values):
        always = "stable" if all(found.misalignment.stable) else "unstable"
        sign = " of that sign" if phi else ""
        rigid = (
            f"; on a transverse spring that is rigid it would be stable from {degrees(closed):.4f} "
            "deg on"
        )
        return (
            f"No misalignment changes that: it is {always} at every φ{sign}"
            f"{rigid if always == 'unstable' and isfinite(closed) else ''}."
        )
    nearest = float(values[np.argmin(np.abs(values - phi))])
    lowest = abs(nearest) == np.min(np.abs(values))
    form = f" ({degrees(closed):.4f} deg in closed form)" if lowest and isfinite(closed) else ""
    way = "more" if abs(nearest) > abs(phi) else "less"
    return (
        f"That changes at φ_c = {degrees(nearest):.4f} deg{form}: the margin is "
        f"{abs(degrees(nearest - phi)):.4g} deg {way} misalignment than now, "
        f"{degrees(phi):.4g} deg."
    )


def supposed(found: Audit) -> list[str]:
    """Return what the theory supposes and this apparatus is not."""
    p, s = found.prediction, found.slider
    if has_state(s.law):
        return [
            "The theory is for friction without internal state: with this law the first column is "
            f"an orientation, with F_0 taken at {in_words(hypot(*s.motion.rate(0.0)), 'm/s')}."
        ]
    if s.phi != 0.0 and p.first_stick > SHORT * p.load_up:
        ratio, share = s.k_y * tan(abs(s.phi)) / s.k_x, p.first_stick / p.load_up
        return [
            f"Eqs. (7) and (10) suppose that the transverse spring is loaded at once, k_y tan φ ≫ "
            f"k_x. Here it is only {ratio:.3g} k_x, and the first stick takes {share:.0%} of the "
            "time until the slip that they give: they are an orientation."
        ]
    return []


def numbers(found: Audit) -> Table:
    """Return predicted quantities beside what the simulation shows."""
    p, seen, s = found.prediction, found.observation, found.slider
    first = float(np.diff(seen.run.stick_intervals[:1]).sum())  # zero if it never sticks
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
        ("creep before the first slip", p.creep_distance, crept(found, slip), "m"),
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


def crept(found: Audit, slip: float) -> float:
    """Return how far the mass has moved when it first slips, m; not a number if it does not."""
    data = found.observation.run.data
    along = abs(data["X"].values - float(data["X"][0]))
    return float(np.interp(slip, data["time"].values, along)) if isfinite(slip) else nan


def peak(found: Audit) -> float:
    """Return what would be read as the coefficient of static friction."""
    largest = float(np.max(found.observation.record.force, initial=0.0))
    return largest / found.slider.normal_load


def stick(found: Audit) -> list[str]:
    """Return which part of what looks like stick is none."""
    seen, s = found.observation, found.slider
    rest, creep, slip = (f"{100.0 * share:.3g} %" for share in seen.shares)
    whole = "of each cycle" if seen.cycles.sizes["cycle"] else "of the time until it slides"
    state = has_state(s.law)
    slowly = "creeping" if s.phi or state else "sliding slowly"
    lines = [
        f"Moving slower than the drive, which a load cell shows as a rising force, takes "
        f"{100.0 * (seen.shares.rest + seen.shares.creep):.3g} % {whole}: at rest {rest}, "
        f"{slowly} {creep}. Moving faster than the drive takes {slip}."
    ]
    if s.phi == 0.0:
        lines.append("There is no misalignment, so friction does not turn.")
    if state and seen.shares.creep > 0.0:
        lines.append(
            "Friction with internal state creeps by itself. What the misalignment adds to it, an "
            "audit of the same apparatus with phi = 0 shows."
            if s.phi
            else "What creeps, creeps by the law of friction."
        )
    elif s.phi and seen.shares.creep > seen.shares.rest:
        distance = seen.mean("creep_distance")
        far = (
            f"{in_words(distance, 'm')} before each slip"
            if isfinite(distance)
            else f"{in_words(found.prediction.creep_distance, 'm')}, by Eq. (7), before it slides"
        )
        lines.append(
            f"What looks like stick is mostly creep under a friction force that turns: an artefact "
            f"of the misalignment. The mass covers {far}. The largest force says how friction "
            f"turned, not that the interface has static friction."
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
    if has_state(found.slider.law):
        return [
            f"The transverse natural frequency is {in_words(p.f_y, 'Hz')}. Whether friction with "
            f"internal state lets it sing, a run sampled at {in_words(p.sample_rate, 'Hz')} shows: "
            "stiction analyse."
        ]
    lines = [
        f"The transverse spring swings at {in_words(p.f_y, 'Hz')} at first, by "
        f"{in_words(p.amplitude, 'm')} (V sin φ/ω_y), {force} of transverse force; towards slip "
        f"the frequency falls, as sin θ, and the swing grows with its period. Sample at "
        f"{in_words(p.sample_rate, 'Hz')} to see it; above {in_words(2.0 * p.f_y, 'Hz')} it is not "
        f"mistaken for another frequency."
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
    works = any(advice.works for advice in found.advices)
    what = "To slide steadily, one of these" if works else "None of these makes it slide steadily"
    return [
        f"{what}; each was simulated, and the last column says what the load cell shows then."
    ], Table(("change", "now", "stable from", "tried", "simulated: force drop, motion"), rows)


def _change(found: Audit, advice: Advice) -> tuple[str, ...]:
    name, now = NAMES[advice.path], in_words(advice.now, advice.unit)
    if advice.tried is None:
        low, high = (in_words(end, advice.unit) for end in advice.between)
        return name, now, "nowhere", f"{low} to {high}", "no value in that range"
    edge, then = in_words(advice.critical, advice.unit), in_words(advice.then, advice.unit)
    before, after = found.observation.mean("drop"), advice.tried.mean("drop")
    fall = f"{in_words(before, 'N')} → {in_words(after, 'N')}"
    regime = advice.tried.regime
    kind = regime.kind if advice.works else f"no remedy: {regime.kind}"
    return name, now, edge, then, f"{fall}; {kind} ({regime.confidence:.2f})"
