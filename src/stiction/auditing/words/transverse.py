"""The transverse oscillation, and the sample rate that shows it."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite, nan, pi
from typing import TYPE_CHECKING

from stiction.analysis.creep.first_slip import slips_at_once
from stiction.analysis.motion.regime.kinds import TRANSVERSE
from stiction.auditing.oscillation import (
    DEAD,
    SWINGS,
    TransverseSwings,
    theoretical_oscillation,
)
from stiction.auditing.prediction import SEEN
from stiction.auditing.simulated_test import LOADS, SLIDES
from stiction.auditing.words.stick import HARDLY, VIBRATES
from stiction.friction import has_state
from stiction.text.quantity.wording import advice, in_words, percent, span
from stiction.text.sections import Table

if TYPE_CHECKING:
    from stiction.auditing.report import Audit

SINGLE = 0.5  # of critical damping: every swing is a sixth of the one before
GROWN = 1.2  # times the first swings: larger ones have grown
DIGITS = 3  # of medians of swings


def transverse(found: Audit) -> tuple[list[str], Table | None]:
    """Return the transverse oscillation of the test, and the sample rate that shows it."""
    if found.prediction.amplitude == 0.0:
        return ["Without misalignment the transverse spring is not excited."], None
    without = _without_creep(found)
    if without:
        return [without], None
    shown = found.oscillation
    if shown.first is None:
        natural = in_words(found.prediction.f_y, "Hz")
        return [
            f"The transverse natural frequency is {natural}. In the simulated test the mass creeps "
            "without swings across the drive."
        ], None
    return [*_during_creep(found, shown)], _beside_theory(found, shown)


def _without_creep(found: Audit) -> str:
    """Return why no transverse oscillation lasts during creep; '' if one does."""
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
    swings, decay = theoretical_oscillation(found.slider)
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
    return ""


def _during_creep(found: Audit, shown: TransverseSwings) -> Iterator[str]:
    """Yield the sentences on the oscillation during creep: its fate, and its sampling."""
    seen = found.observation
    becomes = _what_becomes(shown)
    yield f"During creep the mass oscillates across the drive in the simulated test{becomes}"
    resting = max(each.at_rest for each in shown.swings)
    yield (
        "Theory is linear: it takes a mass that never rests."
        + (
            f" This mass rests for up to {percent(resting)} of its swings, which are slower and "
            "larger for that."
            if resting > HARDLY
            else ""
        )
    )
    yield (
        f"To see it, sample at {advice(SEEN * shown.fastest, 'Hz')}; below "
        f"{in_words(2.0 * shown.fastest, 'Hz')} it appears at another frequency."
    )
    if seen.coarse:
        yield (
            "This test lasts so long that it was sampled at "
            f"{in_words(seen.record.sample_rate, 'Hz')} only; both ends of each creep were "
            "simulated again."
        )


def _what_becomes(shown: TransverseSwings) -> str:
    """Return the fate of the swings before slip or steady sliding, to end a sentence."""
    first = shown.first.amplitude if shown.first else nan
    last = max((each.amplitude for each in shown.last), default=0.0)
    most = shown.largest.amplitude if shown.largest else last
    dies = isfinite(shown.dead) or last < DEAD * first
    if most > GROWN * first:
        grows = ": its swings get slower and larger"
        return f"{grows}, and die out before slip." if dies else f"{grows} towards slip."
    if isfinite(shown.dead):
        return f", and dies out: after {in_words(shown.dead, 's', 2)} it is below a tenth."
    return ", and dies out." if dies else ", and gets smaller."


def _beside_theory(found: Audit, shown: TransverseSwings) -> Table:
    """Return the simulated swings at both ends of creep beside linear theory's."""
    p, k_y = found.prediction, found.slider.k_y
    natural, _ = theoretical_oscillation(found.slider)
    ends = {SLIDES: "steady sliding", LOADS: "the end of the test"}
    end = ends.get(found.observation.comes_to, "a slip")
    parts = [
        ("as creep begins", [shown.first] if shown.first else []),
        ("after a slip", shown.later),
        ("the largest of the first creep", [shown.largest] if shown.largest else []),
        (f"before {end}", shown.last),
    ]
    rows = [
        (
            name,
            _range([each.frequency for each in swings], "Hz"),
            _range([each.amplitude for each in swings], "m"),
            _range([each.amplitude * k_y for each in swings], "N"),
            percent(max(each.at_rest for each in swings)),
        )
        for name, swings in parts
        if swings
    ]
    A = p.amplitude
    theory = in_words(natural, "Hz"), in_words(A, "m"), in_words(A * k_y, "N"), percent(0.0)
    heads = f"swings ({SWINGS} each)", "frequency", "amplitude", "of k_y u_y", "at rest"
    return Table(heads, [*rows, ("linear theory, V sin φ/ω_y", *theory)])


def _range(values: list[float], unit: str) -> str:
    """Return the range of values in words; a single value if they agree to three digits."""
    low, high = min(values), max(values)
    if in_words(low, unit, DIGITS) == in_words(high, unit, DIGITS):
        return in_words(low, unit, DIGITS)
    return span(low, high, unit, DIGITS)
