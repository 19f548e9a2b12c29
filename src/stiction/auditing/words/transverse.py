"""The transverse oscillation, and the sample rate that shows it."""

from __future__ import annotations

from collections.abc import Iterator
from math import sin
from typing import TYPE_CHECKING, Any

from stiction.analysis.motion.regime.kinds import TRANSVERSE
from stiction.auditing.simulated_test import SLIDES
from stiction.auditing.words.stick import HARDLY, VIBRATES
from stiction.friction import has_state
from stiction.system.slider import Slider
from stiction.text.units import in_words

if TYPE_CHECKING:
    from stiction.auditing.report import Audit

SOON = 10.0  # e-folds until the first slip: it dies out in the first half of creep


def transverse(found: Audit) -> list[str]:
    """Return the transverse oscillation, and the sample rate that shows it."""
    if found.prediction.amplitude == 0.0:
        return ["Without misalignment the transverse spring is not excited."]
    without = _without_creep(found)
    return [without] if without else [*_during_creep(found)]


def _without_creep(found: Audit) -> str:
    """Return why no transverse oscillation goes on during creep; nothing if one does."""
    p, seen = found.prediction, found.observation
    rate = in_words(p.sample_rate, "Hz")
    natural = f"The transverse natural frequency is {in_words(p.f_y, 'Hz')}."
    if seen.motion == TRANSVERSE:
        swings = in_words(1.0 / seen.mean("period"), "Hz")
        return (
            f"{natural} The vibration itself, at {swings}, is a transverse oscillation, faster "
            f"than the {in_words(p.f_x, 'Hz')} of the mass on the spring along x alone. To see its "
            f"shape, sample at {rate}."
        )
    if has_state(found.slider.law):
        return (
            f"{natural} Whether the mass oscillates in spite of a friction with internal state can "
            f"be seen in a run sampled at {rate}: stiction analyse."
        )
    if seen.motion in VIBRATES or seen.shares.creep < HARDLY:
        return (
            f"{natural} A transverse oscillation needs creep, and this mass hardly creeps. What "
            f"remains of it can be seen in a run sampled at {rate}."
        )
    creeps = seen.shares.creep * seen.mean("period")
    if creeps * p.f_y < 1.0:
        return (
            f"{natural} A transverse oscillation needs creep, and this mass creeps for "
            f"{in_words(creeps, 's')} in each cycle, less than one period of it."
        )
    decay = transverse_decay(found.slider)
    if decay * p.load_up > SOON:
        return (
            f"{natural} A transverse oscillation begins with creep, and dies out within some "
            f"{in_words(5.0 / decay, 's', 1)}: dampers, or friction that rises with "
            f"speed, damp it. To see it, sample at {rate}."
        )
    return ""


def _during_creep(found: Audit) -> Iterator[str]:
    """Yield the oscillation during creep: its size, what becomes of it, and what shows it."""
    p, seen = found.prediction, found.observation
    end, then = "slip", "the oscillation dies out: friction falls too little with speed to drive it"
    if seen.comes_to == SLIDES:
        end, then = "steady sliding", "the oscillation dies out"
    elif transverse_decay(found.slider) < 0.0:
        then = "the amplitude grows with its period"
    yield (
        f"During creep the mass oscillates across the drive at {in_words(p.f_y, 'Hz')}, by "
        f"{in_words(p.amplitude, 'm')} (V sin φ/ω_y) or "
        f"{in_words(p.amplitude * found.slider.k_y, 'N')}. Towards {end} the frequency "
        f"falls, as sin θ, and {then}."
    )
    yield (
        f"To see it, sample at {in_words(p.sample_rate, 'Hz')}; below "
        f"{in_words(2.0 * p.f_y, 'Hz')} it appears at another frequency."
    )
    if seen.coarse:
        yield (
            "This test lasts so long that it was simulated with "
            f"{in_words(seen.record.sample_rate, 'Hz')} only, which does not show the oscillation."
        )


def transverse_decay(slider: Slider) -> float:
    """Return the rate of decay of the transverse oscillation early in creep, 1/s.

    By (E6) of docs/explanation/estimates.md. If negative, the oscillation lasts.
    """
    speed = slider.drive_speed * abs(sin(slider.misalignment))
    law: Any = slider.law
    slope = float(law.slope(speed)) * slider.normal_load
    return 0.5 * (slider.c_y + slope) / slider.masses[1]
