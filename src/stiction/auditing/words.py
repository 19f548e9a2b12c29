"""The report of an audit in words and tables."""

from __future__ import annotations

from math import degrees, hypot, isfinite, nan, sin, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from stiction.analysis.creep.first_slip import first_slip_time
from stiction.analysis.motion.friction import find_friction
from stiction.analysis.motion.regime import (
    HARMONIC,
    IRREGULAR,
    SETTLING,
    STEADY,
    STICK_SLIP,
    STUCK,
    TRANSITIONAL,
    TRANSVERSE,
    UNDETERMINED,
)
from stiction.analysis.parts.wording import with_error
from stiction.analysis.record import cell_axis
from stiction.auditing.advice import Advice, is_compliance
from stiction.auditing.observation import (
    MOST_WORK,
    OSCILLATES,
    SLIDES,
    SMALL,
    UNSETTLED,
    Observation,
)
from stiction.auditing.prediction import suppositions
from stiction.friction import has_state
from stiction.linear_stability.linear import STABLE, UNSTABLE
from stiction.system.slider import Slider
from stiction.text.sections import Section, Table
from stiction.text.units import in_words

if TYPE_CHECKING:
    from stiction.auditing.report import Audit

MEANS = ("period", "s"), ("drop", "N")  # over the cycles
SHOWN = 1e-3  # of a mean: a smaller error is not worth a word
VIBRATES = (HARMONIC, TRANSVERSE, IRREGULAR)  # about steady sliding: nothing creeps
HARDLY = 0.05  # of the time: a smaller share of creep or rest is negligible
SOON = 10.0  # e-folds until the first slip: it dies out in the first half of creep
ALMOST = 0.1  # of the present force drop: a change that leaves less is nearly a remedy
NAMES = {
    "phi": "misalignment φ",
    "drive.velocity": "drive velocity V",
    "c_x": "damping c_x",
    "k_x": "stiffness k_x",
}


SEEN = {  # kinds of motion, in a sentence
    TRANSITIONAL: f"a {TRANSITIONAL} between stick-slip and harmonic vibration",
    SETTLING: "steady sliding, after a motion at the start that dies out",
    STUCK: "loading without a slip",
    UNDETERMINED: "a motion of no clear kind",
}


def sections(found: Audit) -> list[Section]:
    """Return the sections of the report."""
    return [
        Section("Verdict", verdict(found)),
        Section("Predicted and simulated", violated_assumptions(found), numbers(found)),
        Section("Is it stick?", stick(found)),
        Section("Transverse oscillation", transverse(found)),
        Section("What to change", *changes(found)),
    ]


def verdict(found: Audit) -> list[str]:
    """Return the motion of the apparatus, and its margin to another one."""
    early = [each for each in (found.observation, found.sliding_on) if not each.run.status.ok]
    if early:
        return [f"The simulated test ended early: {early[0].run.status.value}.", stability(found)]
    return [*motions(found), stability(found), margin(found)]


def motions(found: Audit) -> list[str]:
    """Return the simulated motions from rest and from sliding."""
    rest, sliding = found.observation, found.sliding_on
    name = SEEN.get(rest.motion, rest.motion)
    if found.bistable:
        return [
            f"Two motions are possible (it is bistable): from rest it reaches {name}; once it "
            "slides steadily, it continues to slide steadily.",
            f"From rest, springs unloaded: {describe_motion(rest)}. From steady sliding, "
            f"disturbed by 1 % of the drive's speed: {SEEN.get(sliding.motion, sliding.motion)}.",
        ]
    if rest.comes_to == SLIDES and sliding.comes_to == SLIDES:
        what = (
            "It comes to slide steadily, started from rest, and goes on sliding steadily after a "
            "small disturbance."
        )
        if found.sliding.verdict == UNSTABLE:
            what = (
                "In the time of the test it slides steadily, but that does not last: small "
                "disturbances grow, more slowly than the test shows."
            )
        return [what, f"From rest the load cell sees: {describe_motion(rest)}."]
    if rest.comes_to == OSCILLATES and sliding.comes_to == OSCILLATES:
        lines = [
            "It does not slide steadily: from rest, and when it is started sliding, it comes to "
            f"{name}."
        ]
        if rest.motion != sliding.motion:
            other = SEEN.get(sliding.motion, sliding.motion)
            lines = [
                f"It does not slide steadily: from rest it comes to {name}; started sliding, to "
                f"{other}."
            ]
    else:
        lines = [
            f"From rest it comes to {final_motion(rest)}; started from steady sliding, disturbed "
            f"by 1 % of the drive's speed, to {final_motion(sliding)}"
            f"{' in the time of the test' if sliding.comes_to == SLIDES else ''}."
        ]
    return [*lines, f"From rest the load cell sees: {describe_motion(rest)}."]


def final_motion(seen: Observation) -> str:
    """Return the final motion of a test, in words."""
    if seen.comes_to == SLIDES:
        return "steady sliding"
    name = SEEN.get(seen.motion, seen.motion)
    return (
        f"{name} (still growing or dying out when the test ends)"
        if seen.comes_to == UNSETTLED
        else name
    )


def short_motion(seen: Observation) -> str:
    """Return the final motion of a test in a few words, for the title of a figure."""
    if seen.comes_to == SLIDES:
        return STEADY
    name = "tiny oscillation" if seen.motion == SMALL else seen.motion
    return f"{name}, still changing" if seen.comes_to == UNSETTLED else name


def describe_motion(seen: Observation) -> str:
    """Return a kind of motion with its cycles, in one line."""
    count = seen.cycles.sizes["cycle"]
    sure = SEEN.get(seen.motion, seen.motion)
    if seen.motion == seen.regime.kind:
        sure += f" (confidence {seen.regime.confidence:.2f})"
    if not count or seen.comes_to == SLIDES:
        return sure
    period, drop = (mean_in_words(seen.cycles[name].values, unit) for name, unit in MEANS)
    return f"{sure}, {count} cycles of {period} in which the force falls by {drop}"


def mean_in_words(values: np.ndarray, unit: str) -> str:
    """Return a mean over cycles, with its standard error where they differ."""
    mean = float(values.mean())
    error = float(values.std(ddof=1)) / sqrt(len(values)) if len(values) > 1 else 0.0
    return with_error(in_words(mean, unit), error if error > SHOWN * mean else 0.0, unit)


def stability(found: Audit) -> str:
    """Return the stability of steady sliding in a sentence."""
    growth, frequency = found.sliding.growth_rate, float(found.sliding.frequencies[0])
    if found.sliding.verdict not in (STABLE, UNSTABLE):
        return (
            "Steady sliding is on the boundary of stability: disturbances neither grow nor decay."
        )
    stable, time = found.sliding.stable, in_words(1.0 / abs(growth), "s")
    swing = f", oscillating at {in_words(frequency, 'Hz')}" if frequency > 0.0 else ""
    if stable and found.sliding_on.comes_to == OSCILLATES:
        return (
            f"Steady sliding is stable only to disturbances far below 1 % of the drive's speed, "
            f"which decay by e in {time}{swing}: in a test it does not last."
        )
    what = f"stable: small disturbances {'decay' if stable else 'grow'} by e in {time}"
    return f"Steady sliding is {what if stable else 'un' + what}{swing}."


def margin(found: Audit) -> str:
    """Return the margin of phi to its critical values in a sentence."""
    phi, turn = found.slider.misalignment, found.slider.turn
    values = found.misalignment.values - turn
    closed = found.prediction.phi_c
    if not len(values):
        always = "stable" if all(found.misalignment.stable) else "unstable"
        sign = " of that sign" if phi else ""
        rigid = (
            f"; on a transverse spring that is rigid it would be stable from {degrees(closed):.4f} "
            "deg on"
        )
        return (
            f"No misalignment changes its stability: it is {always} at every φ{sign}"
            f"{rigid if always == 'unstable' and isfinite(closed) else ''}."
        )
    nearest = float(values[np.argmin(np.abs(values - phi))])
    lowest = abs(nearest) == np.min(np.abs(values))
    at, form = f"{degrees(nearest):.4f} deg", ""
    if lowest and isfinite(closed):
        plain = f"{degrees(closed):.4f} deg"
        form = ", as in closed form" if plain == at else f" ({plain} in closed form)"
    way = "more" if abs(nearest) > abs(phi) else "less"
    changes = {STABLE: "It becomes unstable", UNSTABLE: "It becomes stable"}
    what = changes.get(found.sliding.verdict, "Its stability changes")
    return (
        f"{what} at φ_c = {at}{form}: the margin is "
        f"{abs(degrees(nearest - phi)):.4g} deg {way} misalignment than now, "
        f"{degrees(phi):.4g} deg."
    )


def violated_assumptions(found: Audit) -> list[str]:
    """Return the assumptions of the theory that this apparatus violates."""
    unmet = suppositions(found.slider, found.prediction)
    if not unmet:
        return []
    return [
        f"Eqs. (7) and (10) suppose that {'; that '.join(unmet)}. Values that follow from them, "
        "marked ~, are only a guide."
    ]


def numbers(found: Audit) -> Table:
    """Return the table of predicted and simulated quantities."""
    p, seen, s = found.prediction, found.observation, found.slider
    first = float(np.diff(seen.run.stick_intervals[:1]).sum())  # zero if it never sticks
    slip = slip_time(seen)
    creep_at_slip, creep_distance = (p.creep_at_slip, p.creep_distance) if p.slips else (nan, nan)
    held = [("friction that holds at rest", p.F_static, None, "N", False)]
    rows = [
        ("friction at vanishing slip F_0", p.F_0, None, "N", False),
        *(held if p.F_static > p.F_0 * (1.0 + 1e-9) else []),
        ("natural frequency along x", p.f_x, None, "Hz", False),
        ("natural frequency along y", p.f_y, None, "Hz", False),
        ("damping number A, Eq. (10)", p.A, None, "", True),
        ("damping ratio ζ at θ = φ, Eq. (10)", p.zeta, None, "", True),
        ("θ at which ζ = 1: slow slip turns fast", p.theta_c, None, "rad", True),
        ("first stick: true rest", nan if has_state(s.law) else p.first_stick, first, "s", False),
        ("time until the first slip", p.load_up if p.slips else nan, slip, "s", True),
        ("creep velocity at first, V sin² φ", p.creep_at_start, None, "m/s", True),
        ("creep velocity when it slips, Eq. (7)", creep_at_slip, None, "m/s", True),
        ("creep before the first slip", creep_distance, creep_before_slip(seen), "m", True),
        ("apparent static friction", p.mu_static, peak(seen), "", True),
        ("apparent kinetic friction", p.mu_kinetic, kinetic(seen), "", True),
        ("force drop", p.drop, seen.mean("drop"), "N", True),
        ("period", p.period, seen.mean("period"), "s", True),
        ("apparent stiffness", apparent_stiffness(s), loading(seen), "N/m", True),
    ]
    mark = "~ " if suppositions(s, p) else ""
    lines = [
        (
            name,
            (mark if rough else "") + in_words(theory, unit),
            "" if shown is None else in_words(shown, unit),
        )
        for name, theory, shown, unit, rough in rows
    ]
    return Table(("quantity", "theory", "simulated"), lines)


def slip_time(seen: Observation) -> float:
    """Return when the first slip begins, s; NaN if there is none."""
    slip = first_slip_time(seen.run)
    return slip if slip < seen.record.time[-1] else nan


def creep_before_slip(seen: Observation) -> float:
    """Return the distance moved until the first slip, m; NaN if there is none."""
    samples, slip = seen.run.samples, slip_time(seen)
    along = np.abs(samples["X"] - samples["X"][0])
    return float(np.interp(slip, samples["time"], along)) if isfinite(slip) else nan


def kinetic(seen: Observation) -> float:
    """Return the apparent coefficient of kinetic friction."""
    found = find_friction(seen.record, seen.regime._replace(kind=seen.motion), seen.cycles).kinetic
    return nan if found is None else found.coefficient


def loading(seen: Observation) -> float:
    """Return the apparent stiffness, N/m; NaN if nothing sticks during loading."""
    return seen.mean("stiffness") if seen.motion == seen.regime.kind and seen.regime.loads else nan


def apparent_stiffness(slider: Slider) -> float:
    """Return the rate of loading over the drive's speed, both along the load cell, N/m.

    By Eq. (7) the transverse spring keeps its force: only the soft one is loaded.
    """
    cell, along = cell_axis(slider), slider.k_x * slider.direction[0]
    share = cell.x * slider.direction[0] + cell.y * slider.direction[1]
    return cell.x * along / share if share else nan


def peak(seen: Observation) -> float:
    """Return the apparent coefficient of static friction."""
    largest = float(np.max(seen.record.force, initial=0.0))
    return largest / seen.run.slider.normal_load


def stick(found: Audit) -> list[str]:
    """Return how much of the apparent stick is creep."""
    seen, s = found.observation, found.slider
    rest, creep, slip = (f"{100.0 * share:.3g} %" for share in seen.shares)
    whole = "of each cycle" if seen.cycles.sizes["cycle"] else "of the time until it slides"
    vibrates, state = seen.motion in VIBRATES, has_state(s.law)
    slowly = "sliding" if vibrates else "creeping" if s.misalignment or state else "sliding slowly"
    lines = [
        f"Moving slower than the drive, which a load cell shows as a rising force, takes "
        f"{100.0 * (seen.shares.rest + seen.shares.creep):.3g} % {whole}: at rest {rest}, "
        f"{slowly} {creep}. Moving faster than the drive takes {slip}."
    ]
    if s.misalignment == 0.0:
        lines.append("There is no misalignment, so friction does not turn.")
    if vibrates:
        rests = "it rests for a moment in each swing" if seen.shares.rest else "it never rests"
        lines.append(f"The mass vibrates about steady sliding; {rests}.")
    elif state and seen.shares.creep > 0.0:
        lines.append(
            "Friction with internal state creeps by itself. An audit of the same apparatus with "
            "phi = 0 shows how much the misalignment adds."
            if s.misalignment
            else "The creep is due to the law of friction."
        )
    elif s.misalignment and seen.shares.creep > seen.shares.rest:
        distance = seen.mean("creep_distance")
        far = (
            f"{in_words(distance, 'm')} before each slip"
            if isfinite(distance)
            else f"{in_words(found.prediction.creep_distance, 'm')}, by Eq. (7), before it slides"
        )
        lines.append(
            f"The apparent stick is mostly creep under a turning friction force: an artefact "
            f"of the misalignment. The mass covers {far}. The largest force says how friction "
            f"turned, not that the interface has static friction."
        )
    elif seen.shares.rest > HARDLY:
        lines.append("The apparent stick is mostly true rest.")
    if seen.motion == STICK_SLIP:
        lines.append(
            "The apparent kinetic coefficient is the mean of peak and trough. The mass overshoots "
            "in each slip, so the trough alone is not a property of the interface."
        )
    return lines


def transverse(found: Audit) -> list[str]:
    """Return the transverse oscillation, and the sample rate that shows it."""
    p, seen = found.prediction, found.observation
    if p.amplitude == 0.0:
        return ["Without misalignment the transverse spring is not excited."]
    frequency, rate = in_words(p.f_y, "Hz"), in_words(p.sample_rate, "Hz")
    natural = f"The transverse natural frequency is {frequency}."
    if has_state(found.slider.law):
        return [
            f"{natural} Whether friction with internal state lets it oscillate, a run sampled at "
            f"{rate} shows: stiction analyse."
        ]
    if seen.motion in VIBRATES or seen.shares.creep < HARDLY:
        return [
            f"{natural} A transverse oscillation needs creep, and this mass hardly creeps. What "
            f"remains of it can be seen in a run sampled at {rate}."
        ]
    creeps = seen.shares.creep * seen.mean("period")
    if creeps * p.f_y < 1.0:
        return [
            f"{natural} A transverse oscillation needs creep, and this mass creeps for "
            f"{in_words(creeps, 's')} in each cycle, less than one period of it."
        ]
    force, decay = in_words(p.amplitude * found.slider.k_y, "N"), transverse_decay(found.slider)
    if decay * p.load_up > SOON:
        return [
            f"{natural} A transverse oscillation begins with creep, and dies out within some "
            f"{in_words(float(f'{5.0 / decay:.1g}'), 's')}: dampers, or friction that rises with "
            f"speed, damp it. To see it, sample at {rate}."
        ]
    then = (
        "the amplitude grows with its period"
        if decay < 0.0
        else "the oscillation dies out: friction falls too little with speed to drive it"
    )
    lines = [
        f"During creep the mass oscillates across the drive at {frequency}, by "
        f"{in_words(p.amplitude, 'm')} (V sin φ/ω_y) or {force}. Towards slip the frequency falls, "
        f"as sin θ, and {then}.",
        f"To see it, sample at {rate}; below {in_words(2.0 * p.f_y, 'Hz')} it appears at another "
        "frequency.",
    ]
    if seen.coarse:
        rate = in_words(seen.record.sample_rate, "Hz")
        lines.append(f"Such a long test was simulated with {rate}, which does not show it.")
    return lines


def transverse_decay(slider: Slider) -> float:
    """Return the rate of decay of the transverse oscillation early in creep, 1/s.

    There the mass slips across the drive, at V sin(phi) on average, and friction is a damper of
    the slope of its law. If negative, the oscillation lasts.
    """
    speed = hypot(*slider.motion.rate(0.0)) * abs(sin(slider.misalignment))
    law: Any = slider.law
    slope = float(law.slope(speed)) * slider.normal_load
    return 0.5 * (slider.c_y + slope) / slider.masses[1]


def changes(found: Audit) -> tuple[list[str], Table | None]:
    """Return changes that make it slide steadily, each with its simulation from rest."""
    if not found.advices:
        return ["Nothing: it slides steadily after the start."], None
    rows = [_change(found, advice) for advice in found.advices]
    goal = "take away the oscillation from rest" if found.bistable else "slide steadily"
    remedies = [
        f"{name_of(found, each.path)} of {in_words(each.then, each.unit)}"
        for each in found.advices
        if each.works
    ]
    what = f"To {goal}: {', or '.join(remedies)}" if remedies else f"None of these makes it {goal}"
    lines = [f"{what}. Each change was simulated from rest; the last column shows the result."]
    cut = [name_of(found, each.path) for each in found.advices if each.cut]
    if cut:
        lines.append(
            f"Values farther from the present one were not tried of {', or '.join(cut)}: all "
            f"simulations of an audit together take no more than {MOST_WORK / 1e6:g} million steps "
            "and samples."
        )
    if found.bistable:
        lines.append(
            "Nothing has to be changed for a test that is started from steady sliding, as long as "
            "no disturbance stops the mass."
        )
    return lines, Table(("change", "now", "stable", "tried", "simulated from rest"), rows)


def name_of(found: Audit, path: str) -> str:
    """Return a parameter in words."""
    slider = found.slider
    if path == "phi" and slider.turn:
        return "phi in [slider]"
    for each in slider.springs:
        if path.startswith(f"springs.{each.slug}."):
            quantity = "" if is_compliance(path) else "stiffness "
            return f"{quantity}{path.rpartition('.')[2]} of the {each.name}"
    return NAMES[path]


def _change(found: Audit, advice: Advice) -> tuple[str, ...]:
    name, now = name_of(found, advice.path), in_words(advice.now, advice.unit)
    if advice.tried is None:
        low, high = (in_words(end, advice.unit) for end in advice.between)
        tried = f"{low} to {high}" if isfinite(advice.between[0]) else "none"
        if advice.cut:
            return name, now, "", "none", "not tried"
        return name, now, "nowhere", tried, "no value in that range"
    then, seen = in_words(advice.then, advice.unit), advice.tried
    side = "above" if advice.critical > advice.now else "below"
    edge = (
        f"{side} {in_words(advice.critical, advice.unit)}" if isfinite(advice.critical) else "now"
    )
    if advice.works:
        return name, now, edge, then, final_motion(seen)
    if not seen.run.status.ok:
        until = in_words(float(seen.record.time[-1]), "s")
        return name, now, edge, then, f"not known: the simulation was cut at {until}"
    what, drop = f"no remedy: {final_motion(seen)}", seen.mean("drop")
    if seen.comes_to == OSCILLATES and isfinite(drop):
        if drop < ALMOST * found.observation.mean("drop"):
            what = f"almost: {final_motion(seen)}"
        what += f", force drop {in_words(drop, 'N')}"
    return name, now, edge, then, what
