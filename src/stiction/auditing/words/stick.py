"""What an audit says of stick, and of the transverse motion, in sentences."""

from __future__ import annotations

from math import hypot, isfinite, sin
from typing import TYPE_CHECKING, Any

from stiction.analysis.motion.regime.kinds import HARMONIC, IRREGULAR, STICK_SLIP, TRANSVERSE
from stiction.auditing.simulated_test import SLIDES
from stiction.friction import has_state
from stiction.system.slider import Slider
from stiction.text.quantity_text import percent
from stiction.text.units import in_words

if TYPE_CHECKING:
    from stiction.auditing.report import Audit

VIBRATES = (HARMONIC, TRANSVERSE, IRREGULAR)  # about steady sliding: nothing creeps
HARDLY = 0.05  # of the time: a smaller share of creep or rest is negligible
SOON = 10.0  # e-folds until the first slip: it dies out in the first half of creep


def stick(found: Audit) -> list[str]:
    """Return how much of the apparent stick is creep."""
    seen, s = found.observation, found.slider
    whole = "of each cycle" if len(seen.table) else "of the time until it slides"
    vibrates, state = seen.motion in VIBRATES, has_state(s.law)
    slowly = "creeps" if s.misalignment or state else "slides slowly"
    slow = ("rests", seen.shares.rest), (slowly, seen.shares.creep)
    how = " and ".join(f"{verb} for {percent(share)}" for verb, share in slow if share)
    lines = [
        f"For {percent(seen.shares.rest + seen.shares.creep)} {whole} the mass is slower than the "
        f"drive, and the load cell shows a rising force{'' if vibrates else f': the mass {how}'}. "
        + (
            f"For {percent(seen.shares.slip)} it is faster than the drive."
            if seen.shares.slip
            else "It is never faster than the drive."
        )
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
            f"of the misalignment. The mass covers {far}. The largest force shows how far "
            f"friction has turned; it is no evidence of static friction."
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
    if seen.motion == TRANSVERSE:
        swings = in_words(1.0 / seen.mean("period"), "Hz")
        return [
            f"{natural} The vibration itself, at {swings}, is a transverse oscillation, faster "
            f"than the {in_words(p.f_x, 'Hz')} of the mass on the spring along x alone. To see its "
            f"shape, sample at {rate}."
        ]
    if has_state(found.slider.law):
        return [
            f"{natural} Whether the mass oscillates in spite of a friction with internal state can "
            f"be seen in a run sampled at {rate}: stiction analyse."
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
            f"{in_words(5.0 / decay, 's', 1)}: dampers, or friction that rises with "
            f"speed, damp it. To see it, sample at {rate}."
        ]
    end, then = "slip", "the oscillation dies out: friction falls too little with speed to drive it"
    if seen.comes_to == SLIDES:
        end, then = "steady sliding", "the oscillation dies out"
    elif decay < 0.0:
        then = "the amplitude grows with its period"
    lines = [
        f"During creep the mass oscillates across the drive at {frequency}, by "
        f"{in_words(p.amplitude, 'm')} (V sin φ/ω_y) or {force}. Towards {end} the frequency "
        f"falls, as sin θ, and {then}.",
        f"To see it, sample at {rate}; below {in_words(2.0 * p.f_y, 'Hz')} it appears at another "
        "frequency.",
    ]
    if seen.coarse:
        rate = in_words(seen.record.sample_rate, "Hz")
        lines.append(
            f"This test lasts so long that it was simulated with {rate} only, which does not show "
            "the oscillation."
        )
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
