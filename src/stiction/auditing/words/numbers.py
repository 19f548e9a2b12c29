"""The table of predicted and simulated quantities of an audit."""

from __future__ import annotations

from math import isnan, nan
from typing import TYPE_CHECKING

import numpy as np

from stiction.analysis.creep.first_slip import slips_at_once
from stiction.analysis.motion.friction import friction_of
from stiction.analysis.signals.correlated_noise import statistics
from stiction.auditing.assumptions import creep_suppositions, suppositions
from stiction.auditing.simulated_test import LOADS, SimulatedTest, creep_before_slip
from stiction.friction import has_state
from stiction.linear_stability.linear import STABLE, UNSTABLE
from stiction.system.slider import Slider
from stiction.text.quantity.wording import in_words, to_error
from stiction.text.sections import Table

if TYPE_CHECKING:
    from stiction.auditing.report import Audit


def violated_assumptions(found: Audit) -> list[str]:
    """Return the assumptions of the theory that this apparatus violates."""
    on = found.slider, found.prediction
    unmet = [*suppositions(*on), *creep_suppositions(*on)]
    if not unmet:
        return []
    return [
        "Values marked ~ follow from Eqs. (7) and (10), and are only a guide: the apparatus does "
        "not meet all assumptions of these equations.",
        *(f"They assume that {each}." for each in unmet),
    ]


def numbers(found: Audit) -> Table:
    """Return the table of predicted and simulated quantities."""
    p, seen, s = found.prediction, found.observation, found.slider
    creep_at_slip, creep_distance = (p.creep_at_slip, p.creep_distance) if p.slips else (nan, nan)
    theta_c = p.theta_c if p.zeta < 1.0 else nan  # else friction never turns so far
    until_creep = nan if has_state(s.law) else p.first_stick
    until_slip = p.load_up if p.slips else nan
    rough = bool(suppositions(s, p))
    creep_rough = rough or bool(creep_suppositions(s, p))
    creep = "creep before the first slip", creep_distance, creep_before_slip(seen), "m", creep_rough
    held = [("static friction", p.F_static, "", "N", False)]
    rows: list[tuple[str, float, float | str, str, bool]] = [
        ("friction F_0 at vanishing slip", p.F_0, "", "N", False),
        *(held if p.F_static > p.F_0 * (1.0 + 1e-9) else []),
        ("natural frequency along x", p.f_x, "", "Hz", False),
        ("natural frequency along y", p.f_y, "", "Hz", False),
        ("damping number A, Eq. (10)", p.A, "", "", rough),
        ("damping ratio ζ at θ = φ, Eq. (10)", p.zeta, "", "", rough),
        ("θ at which ζ = 1: slow slip turns fast", theta_c, "", "rad", rough),
        ("first stick (true rest)", until_creep, _rest(seen), "s", False),
        ("time until the first slip", until_slip, _slip(seen), "s", rough),
        ("creep velocity at first, V sin² φ", p.creep_at_start, "", "m/s", rough),
        ("creep velocity when it slips, Eq. (7)", creep_at_slip, "", "m/s", rough),
        creep,
        ("apparent static friction, largest force", p.mu_static, largest(seen), "", rough),
        ("apparent kinetic friction, mean", p.mu_kinetic, kinetic(seen), "", rough),
        ("force drop, mean", p.drop, mean_of(seen, "drop", "N"), "N", rough),
        ("period, mean", p.period, mean_of(seen, "period", "s"), "s", rough),
        ("apparent stiffness, mean", apparent_stiffness(s), loading(seen), "N/m", rough),
        *_growth(found),
    ]
    lines = [
        (
            name,
            ("~ " if guide and not isnan(theory) else "") + in_words(theory, unit),
            shown if isinstance(shown, str) else in_words(shown, unit),
        )
        for name, theory, shown, unit, guide in rows
    ]
    return Table(("quantity", "theory", "simulated"), lines)


def _growth(found: Audit) -> list[tuple[str, float, str, str, bool]]:
    """Return the row of the growth or decay time of small disturbances of steady sliding."""
    if found.sliding.verdict not in (STABLE, UNSTABLE):
        return []
    way = "decay" if found.sliding.stable else "growth"
    name = f"{way} of small disturbances, factor of e in"
    return [(name, 1.0 / abs(found.sliding.growth_rate), "", "s", False)]


def _rest(seen: SimulatedTest) -> str:
    """Return the duration of the first stick; a lower bound where the test ends with it."""
    end = seen.run.samples["time"][-1]
    first = np.minimum(seen.run.stick_intervals[:1], end)  # empty if it never sticks
    lasts = in_words(float(np.diff(first).sum()), "s")
    return f"> {lasts}" if np.any(first == end) else lasts


def _slip(seen: SimulatedTest) -> str:
    """Return the time of the first slip; a lower bound where the test ends too early."""
    if isnan(seen.slip_time) and not seen.decided:
        return f"> {in_words(seen.duration, 's')}"
    return in_words(seen.slip_time, "s")


def mean_of(seen: SimulatedTest, quantity: str, unit: str) -> str:
    """Return the mean of a quantity over cycles, to the first digit of its standard error."""
    values = seen.table[quantity]
    return to_error(*statistics(values)[:2], unit) if len(values) else in_words(nan, unit)


def kinetic(seen: SimulatedTest) -> float:
    """Return the apparent coefficient of kinetic friction."""
    found = friction_of(seen.record, seen.regime._replace(kind=seen.motion), seen.table).kinetic
    return nan if found is None else found.coefficient


def loading(seen: SimulatedTest) -> float:
    """Return the apparent stiffness, N/m; NaN if nothing sticks during loading."""
    return seen.mean("stiffness") if seen.motion == seen.regime.kind and seen.regime.loads else nan


def apparent_stiffness(slider: Slider) -> float:
    """Return the rate of loading over the drive's speed, both along the load cell, N/m.

    By Eq. (7) the transverse spring keeps its force, and only the soft one is loaded; both are
    where the first stick ends in a slip.
    """
    cell, (x, y) = slider.load_cell, slider.direction
    across = cell.y * slider.k_y * y if slips_at_once(slider) else 0.0
    return (cell.x * slider.k_x * x + across) / cell.share if cell.share else nan


def peak(seen: SimulatedTest) -> float:
    """Return the apparent coefficient of static friction."""
    return float(np.max(seen.record.force, initial=0.0)) / seen.run.slider.normal_load


def largest(seen: SimulatedTest) -> str:
    """Return the apparent static friction; a lower bound while the springs are loaded."""
    return f"{'> ' if seen.comes_to == LOADS else ''}{in_words(peak(seen), '')}"
