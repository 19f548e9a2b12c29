"""The transverse oscillation, and the sample rate that shows it."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite, pi, sin
from typing import TYPE_CHECKING, Any

import numpy as np

from stiction import theory
from stiction.analysis.creep.first_slip import along_force, force_direction, slips_at_once
from stiction.analysis.motion.regime.kinds import TRANSVERSE
from stiction.auditing.simulated_test import SLIDES
from stiction.auditing.words.stick import HARDLY, VIBRATES
from stiction.friction import has_state
from stiction.system.slider import Slider
from stiction.system.tensors import damping_tensor
from stiction.text.units import advice, in_words

if TYPE_CHECKING:
    from stiction.auditing.report import Audit

SINGLE = 0.5  # of critical damping: every swing is a sixth of the one before
SOON = 10.0  # e-folds while the spring is loaded: it dies out in the first half of that


def transverse(found: Audit) -> list[str]:
    """Return the transverse oscillation, and the sample rate that shows it."""
    if found.prediction.amplitude == 0.0:
        return ["Without misalignment the transverse spring is not excited."]
    without = _without_creep(found)
    return [without] if without else [*_during_creep(found)]


def _without_creep(found: Audit) -> str:
    """Return why no transverse oscillation goes on during creep; nothing if one does."""
    p, seen = found.prediction, found.observation
    rate = advice(p.sample_rate, "Hz")
    natural = f"The transverse natural frequency is {in_words(p.f_y, 'Hz')}."
    if seen.motion == TRANSVERSE:
        period = seen.mean("period")  # NaN if the load cell tells no cycles
        rhythm = f", at {in_words(1.0 / period, 'Hz')}," if isfinite(period) else ""
        return (
            f"{natural} The vibration itself{rhythm} is a transverse oscillation, faster "
            f"than the {in_words(p.f_x, 'Hz')} of the mass on the spring along x alone. To see its "
            f"shape, sample at {rate}."
        )
    if has_state(found.slider.law):
        return (
            f"{natural} Whether the mass oscillates in spite of a friction with internal state can "
            f"be seen in a run sampled at {rate}: stiction analyse."
        )
    if seen.motion in VIBRATES or seen.shares.creep < HARDLY:
        hardly = "hardly creeps"
        if seen.motion in VIBRATES:
            hardly = "creeps at most until it vibrates"
        return (
            f"{natural} A transverse oscillation needs creep, and this mass {hardly}. What "
            f"remains of it can be seen in a run sampled at {rate}."
        )
    swings, decay = oscillation(found.slider)
    ratio = decay / (2.0 * pi * swings)
    if ratio > SINGLE:
        return (
            f"{natural} A transverse oscillation is hardly seen: dampers, or friction that rises "
            f"with speed, damp the motion along the force at {in_words(ratio, '')} of critical "
            "damping."
        )
    creeps = seen.shares.creep * seen.mean("period")
    if creeps * p.f_y < 1.0:
        return (
            f"{natural} A transverse oscillation needs creep, and this mass creeps for "
            f"{in_words(creeps, 's')} in each cycle, less than one period of it."
        )
    if slips_at_once(found.slider):
        return (
            f"{natural} A transverse oscillation needs creep, and here the first stick ends in a "
            f"slip: the mass swings along the force of both springs, at {in_words(swings, 'Hz')}."
        )
    if decay * max(p.load_up, found.slider.loading_time) > SOON:
        return (
            f"{natural} A transverse oscillation begins with creep, and dies out within some "
            f"{in_words(5.0 / decay, 's', 1)}: dampers, or friction that rises with "
            f"speed, damp it. To see it, sample at {rate}."
        )
    return ""


def _during_creep(found: Audit) -> Iterator[str]:
    """Yield the oscillation during creep: its size, what becomes of it, and what shows it."""
    p, seen = found.prediction, found.observation
    swings, decay = oscillation(found.slider)
    end, then = "slip", "the oscillation dies out: friction falls too little with speed to drive it"
    if seen.comes_to == SLIDES:
        end, then = "steady sliding", "the oscillation dies out"
    elif decay < 0.0:
        then = "the amplitude grows with its period"
    yield (
        f"During creep the mass oscillates across the drive at {in_words(swings, 'Hz')}, by "
        f"{in_words(p.amplitude, 'm')} (V sin φ/ω_y) or "
        f"{in_words(p.amplitude * found.slider.k_y, 'N')}. Towards {end} the frequency "
        f"falls, as sin θ, and {then}."
    )
    yield (
        f"To see it, sample at {advice(p.sample_rate, 'Hz')}; below "
        f"{in_words(2.0 * swings, 'Hz')} it appears at another frequency."
    )
    if seen.coarse:
        yield (
            "This test lasts so long that it was sampled at "
            f"{in_words(seen.record.sample_rate, 'Hz')} only: a period of the oscillation has "
            f"{in_words(seen.record.sample_rate / swings, '', 2)} samples."
        )


def oscillation(slider: Slider) -> tuple[float, float]:
    """Return frequency (Hz) and rate of decay (1/s) of the transverse oscillation early in creep.

    It goes along the force at the end of the first stick, on the springs, the mass and the dampers
    in that direction, by (E6) of docs/explanation/estimates.md. If the rate is negative, it lasts.
    """
    (k, m), e = along_force(slider), np.array(force_direction(slider))
    speed = slider.drive_speed * abs(sin(slider.misalignment) / e[1])
    law: Any = slider.law
    slope = float(law.slope(speed)) * slider.normal_load
    decay = 0.5 * (float(e @ damping_tensor(slider) @ e) + slope) / m
    return float(theory.natural_frequency(k, m)) / (2.0 * pi), decay
