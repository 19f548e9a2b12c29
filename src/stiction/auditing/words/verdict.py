"""The verdict of an audit: the motions, their stability, the margin to other ones."""

from __future__ import annotations

from math import copysign, isfinite
from typing import TYPE_CHECKING

import numpy as np

from stiction.analysis.motion.regime.kinds import (
    SETTLING,
    STEADY,
    TRANSITIONAL,
    UNDETERMINED,
)
from stiction.analysis.signals.correlated_noise import statistics
from stiction.auditing.simulated_test import LOADS, OSCILLATES, SLIDES, SMALL, SimulatedTest
from stiction.auditing.words.stick import ROUGHLY, answer, no_decision
from stiction.friction.law import implausible
from stiction.linear_stability import Critical
from stiction.linear_stability.examination import (
    beside_critical_stiffness,
    critical_stiffness_of,
)
from stiction.linear_stability.linear import STABLE, UNSTABLE
from stiction.system.load_cell import ACROSS
from stiction.text.quantity.wording import in_words, to_error, with_error

if TYPE_CHECKING:
    from stiction.auditing.report import Audit

RECORD = "What the record says"  # title of the verdict on a measured record
# and of that on the apparatus: beside a record, the verdict is what the record says
VERDICT, AS_DESCRIBED = "Verdict", "The rig as it is described"
MEANS = ("period", "s"), ("drop", "N")  # over the cycles
SHOWN_ERROR = 1e-3  # of a mean: a smaller error is not worth a word
SEEN = {  # kinds of motion, in a sentence
    TRANSITIONAL: f"a {TRANSITIONAL} between stick-slip and harmonic vibration",
    SETTLING: "steady sliding, after a motion at the start that dies out",
    UNDETERMINED: "a motion of no clear kind",
}


def verdict(found: Audit) -> list[str]:
    """Return the verdict: static friction or not, the motion, its stability and its margin."""
    early = [each for each in (found.observation, found.sliding_on) if not each.run.status.ok]
    doubts = implausible(found.slider.law)
    if early:
        ended = f"The simulated test ended early: {early[0].run.status.value}."
        return [*doubts, ended, stability(found)]
    lines = [answer(found), *motions(found), *without_misalignment(found), stability(found)]
    return [*doubts, *lines, *critical_stiffness(found), margin(found)]


def without_misalignment(found: Audit) -> list[str]:
    """Return the motion without misalignment, where friction creeps by itself, for comparison."""
    other = found.aligned
    if other is None or not other.run.status.ok:
        return []
    return [
        f"Without misalignment, all else as it is, the load cell shows {describe_motion(other)}: "
        "the difference is what the misalignment adds."
    ]


def critical_stiffness(found: Audit) -> list[str]:
    """Return the stiffness beside the critical one of rate and state, and its meaning."""
    its = critical_stiffness_of(found.slider)
    said = beside_critical_stiffness(found.slider, its)
    if its is None or not len(its.values):
        return said
    if found.sliding.stable:
        return [*said, "On a spring softer than k_c the same friction sticks and slips."]
    return [
        *said,
        "A spring so soft cannot follow friction as it weakens: stick-slip is that of spring and "
        "friction together, and with a stiffer spring, or less load, the same friction slides.",
    ]


def motions(found: Audit) -> list[str]:
    """Return the simulated motions from rest and from sliding."""
    rest, sliding = found.observation, found.sliding_on
    name = SEEN.get(rest.motion, rest.motion) + short_rest(rest)
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
        cell = f"the load cell shows {describe_motion(rest)}"
        return [
            what,
            f"Started from rest, {cell}. Steady sliding is reached {time_and_travel(rest)}.",
        ]
    if rest.comes_to == OSCILLATES and sliding.comes_to == OSCILLATES:
        lines = [f"It does not slide steadily: started from rest or sliding, it comes to {name}."]
        if rest.motion != sliding.motion:
            other = SEEN.get(sliding.motion, sliding.motion) + short_rest(sliding)
            lines = [
                f"It does not slide steadily: from rest it comes to {name}; started sliding, to "
                f"{other}."
            ]
    else:
        lasting = " in the time of the test" if sliding.comes_to == SLIDES else ""
        lines = [
            f"From rest {outcome(rest)}; started from steady sliding, disturbed by 1 % of the "
            f"drive's speed, {outcome(sliding)}{lasting}."
        ]
    return [*lines, f"Started from rest, the load cell shows {describe_motion(rest)}."]


def outcome(seen: SimulatedTest) -> str:
    """Return the final motion of a test, or that it ended too early, as a main clause."""
    if seen.comes_to == LOADS:
        return f"the motion is {no_decision(seen)}, as the springs are still being loaded"
    return f"it comes to {final_motion(seen)}"


def final_motion(seen: SimulatedTest) -> str:
    """Return the final motion of a test, in words."""
    if seen.comes_to == SLIDES:
        return "steady sliding"
    name = SEEN.get(seen.motion, seen.motion) + short_rest(seen)
    if seen.comes_to == LOADS:
        return f"{name} of {in_words(seen.duration, 's', ROUGHLY)}"
    if seen.decided:
        return name
    if seen.motion in (SETTLING, STEADY):  # as far as the load cell sees it
        return "a motion that still changes when the test ends"
    return f"{name} (still growing or dying out when the test ends)"


def motion_and_travel(seen: SimulatedTest) -> str:
    """Return the final motion of a test; for steady sliding, with its time and travel."""
    motion = final_motion(seen)
    return f"{motion}, reached {time_and_travel(seen)}" if seen.comes_to == SLIDES else motion


def time_and_travel(seen: SimulatedTest) -> str:
    """Return the time and the drive's travel until steady sliding, in words."""
    return f"after {settling(seen)[0]}, {travel(seen)}"


def travel(seen: SimulatedTest) -> str:
    """Return the drive's travel until steady sliding, in words."""
    return f"on {settling(seen)[1]} of travel"


def settling(seen: SimulatedTest) -> tuple[str, str]:
    """Return the time and the drive's travel until steady sliding."""
    if isfinite(seen.travel):
        return in_words(seen.settled, "s", ROUGHLY), in_words(seen.travel, "m", ROUGHLY)
    way = seen.run.slider.drive_speed * seen.duration
    times = in_words(seen.duration, "s", ROUGHLY), in_words(way, "m", ROUGHLY)
    return f"more than {times[0]}", f"more than {times[1]}"


def short_rest(seen: SimulatedTest) -> str:
    """Return the duration of the sticks, if the mass slides for most of each cycle; or ''."""
    named = seen.motion == seen.regime.kind and not seen.regime.loads
    return f", {seen.regime.rests}" if named and seen.regime.rests else ""


def short_motion(seen: SimulatedTest) -> str:
    """Return the final motion of a test in a few words, for the title of a figure."""
    if seen.comes_to == SLIDES:
        return STEADY
    name = "tiny oscillation" if seen.motion == SMALL else seen.motion
    return name if seen.decided or seen.comes_to == LOADS else f"{name}, still changing"


def describe_motion(seen: SimulatedTest) -> str:
    """Return a kind of motion with its cycles, in one line, as the load cell shows it."""
    if seen.blind:
        return f"nothing: it {ACROSS}"
    count = len(seen.table)
    sure = SEEN.get(seen.motion, seen.motion)
    if seen.motion == seen.regime.kind:
        sure = seen.regime.surely.replace(seen.motion, sure, 1)
    if not count or seen.comes_to == SLIDES:
        return sure
    period, drop = (mean_in_words(seen.table[name], unit) for name, unit in MEANS)
    return f"{sure}, {count} cycles of {period} in which the force falls by {drop}"


def mean_in_words(values: np.ndarray, unit: str) -> str:
    """Return a mean over cycles, with its standard error if they differ."""
    mean, error, _ = statistics(values)
    say = with_error if error > SHOWN_ERROR * mean else to_error
    return say(mean, error, unit)


def stability(found: Audit) -> str:
    """Return the stability of steady sliding in a sentence."""
    frequency = float(found.sliding.frequencies[0])
    if found.sliding.verdict not in (STABLE, UNSTABLE):
        return (
            "Steady sliding is on the boundary of stability: disturbances neither grow nor decay."
        )
    stable = found.sliding.stable
    swing = f", oscillating at {in_words(frequency, 'Hz')}" if frequency > 0.0 else ""
    if stable and found.sliding_on.comes_to == OSCILLATES:
        return (
            "Steady sliding is stable only to disturbances far below 1 % of the drive's speed"
            f"{swing}: in a test it does not last."
        )
    what = "stable: small disturbances decay" if stable else "unstable: small disturbances grow"
    return f"Steady sliding is {what}{swing}."


def margin(found: Audit) -> str:
    """Return the margin of phi to its critical values in a sentence."""
    phi, turn = found.slider.misalignment, found.slider.turn
    values = found.misalignment.values - turn
    closed = copysign(found.prediction.phi_c, phi)
    if not len(values):
        always = "stable" if all(found.misalignment.stable) else "unstable"
        low, high = (in_words(end - turn, "rad") for end in found.misalignment.between)
        if found.misalignment.neutral:
            return f"No misalignment changes that: so it is at every φ from {low} to {high}."
        if found.sliding.verdict not in (STABLE, UNSTABLE):
            return f"At any other φ from {low} to {high} steady sliding is {always}."
        rigid = (
            "; with a rigid transverse spring it would be stable "
            f"{'above' if closed > 0.0 else 'below'} {in_words(closed, 'rad')}"
        )
        return (
            f"No misalignment changes that: steady sliding is {always} at every φ from {low} to "
            f"{high}{rigid if always == 'unstable' and isfinite(closed) else ''}."
        )
    nearest = float(values[np.argmin(np.abs(values - phi))])
    lowest = abs(nearest) == np.min(np.abs(values))
    at, form = in_words(nearest, "rad"), ","
    if lowest and isfinite(closed):
        plain = in_words(closed, "rad")
        rigid = "with a rigid transverse spring"
        form = f", as {rigid}," if plain == at else f" ({plain} {rigid}),"
    way = "more" if nearest > phi else "less"
    changes = {STABLE: "It becomes unstable", UNSTABLE: "It becomes stable"}
    what = changes.get(found.sliding.verdict, "Its stability changes")
    said = (
        f"{what} at φ_c = {at}{form} which is {in_words(abs(nearest - phi), 'rad')} {way} than "
        f"the present misalignment of {in_words(phi, 'rad')}."
    )
    if len(values) == 1:
        return said
    other = found.sliding.verdict != STABLE
    kind = STABLE if other else UNSTABLE
    return f"{said} It is {kind} {where(found.misalignment, other, turn)}."


def where(found: Critical, stable: bool, origin: float = 0.0) -> str:
    """Return the ranges in which sliding is stable, or unstable, without the ends of the search."""
    said = []
    for low, high, kind in found.stretches:
        if kind != stable:
            continue
        first, last = (in_words(end - origin, found.unit) for end in (low, high))
        if low == found.between[0]:
            said.append(f"below {last}")
        elif high == found.between[1]:
            said.append(f"above {first}")
        else:
            said.append(f"from {first} to {last}")
    return " and ".join(said)
