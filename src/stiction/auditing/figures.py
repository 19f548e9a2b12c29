"""The figures of an audit; None if there is nothing to draw."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from stiction.analysis.creep.curve import creep_curves, mean_creep
from stiction.auditing.advice import Remedy
from stiction.auditing.pairs import Pair
from stiction.auditing.words.changes import in_symbols, name_of
from stiction.auditing.words.stick import HARDLY, VIBRATES
from stiction.auditing.words.verdict import short_motion
from stiction.friction import has_state
from stiction.linear_stability import boundary
from stiction.plotting.analysis.creep_curve import creep_theory, plot_creep
from stiction.plotting.analysis.tolerance import plot_tolerance
from stiction.plotting.analysis.trials import Trial, plot_trials
from stiction.plotting.inference.mechanism import plot_mechanism
from stiction.plotting.inference.posterior import (
    plot_corner,
    plot_posterior,
    plot_predictive,
    plot_ranks,
)
from stiction.plotting.page.canvas import figure_of
from stiction.plotting.stability.boundary import plot_boundary
from stiction.reproduction.figures import figure5
from stiction.text.quantity.wording import in_words

if TYPE_CHECKING:
    from stiction.auditing.report import Audit
    from stiction.inference.posterior import Fit


def test(found: Audit) -> Figure | None:
    """Draw the simulated force, as a load cell records it."""
    return figure_of(found.plot)


def creep(found: Audit) -> Figure | None:
    """Draw the creep before slip with Eqs. (7) and (8); None if there is hardly any creep."""
    seen, slider = found.observation, found.slider
    if seen.motion in VIBRATES or seen.shares.creep < HARDLY or not len(seen.table):
        return None
    curves = creep_curves(seen.run, seen.cycles)
    if slider.misalignment == 0.0 or not np.isfinite(curves["velocity"].values).any():
        return None
    V, phi = slider.drive_speed, abs(slider.misalignment)
    # Eqs. (7) and (8) suppose friction without internal state
    lines = None if has_state(slider.law) else creep_theory(V, phi, slider.F_0 / slider.k_x)
    return figure_of(plot_creep, curves, mean_creep(curves), V, lines)


def damping(found: Audit) -> Figure | None:
    """Draw the damping diagram with the path of the friction force, now and as advised.

    None for friction with internal state, to which Eq. (10) does not apply.
    """
    if found.slider.misalignment == 0.0 or has_state(found.slider.law):
        return None
    turn = found.slider.turn
    advised = (each.then - turn for each in found.advices if each.path == "phi" and each.works)
    return figure5(found.slider, next(advised, None))


def trials(found: Audit) -> Figure | None:
    """Draw the force of the test, now and with each change."""
    tried = [
        Trial(f"{_change(found, each)}: {short_motion(each.tried)}", each.tried.record)
        for each in found.remedies
        if each.tried is not None
    ]
    return figure_of(plot_trials, found.observation.record, tried) if tried else None


def _change(found: Audit, each: Remedy | Pair) -> str:
    """Return a change for the title of a figure."""
    if isinstance(each, Pair):
        return in_symbols(each)
    return f"{name_of(found, each.path)} = {in_words(each.then, each.unit)}"


def record(found: Audit) -> Figure | None:
    """Draw a measured record beside simulations; None if none was fitted."""
    seen = found.measured
    return figure_of(plot_predictive, seen) if seen and seen.predictive else None


def mechanism(found: Audit) -> Figure | None:
    """Draw the odds of mechanisms for a measured record."""
    seen = found.measured
    return figure_of(plot_mechanism, seen.odds) if seen and seen.odds else None


def of_fit(plot: Callable[[Fit], Any]) -> Callable[[Audit], Figure | None]:
    """Return the function that draws the fit of a measured record; None without a fit."""

    def draw(found: Audit) -> Figure | None:
        fit = found.measured and found.measured.fit
        return figure_of(plot, fit) if fit else None

    return draw


posterior, corner, ranks = of_fit(plot_posterior), of_fit(plot_corner), of_fit(plot_ranks)


def tolerance(found: Audit) -> Figure | None:
    """Draw the tolerance budget over the misalignment; None if the misalignment is certain."""
    shown = found.budget is not None and not found.budget.certain
    return figure_of(plot_tolerance, found.budget) if shown else None


def stability(found: Audit) -> Figure | None:
    """Draw the stability of steady sliding over misalignment and drive velocity."""
    curve = boundary(found.slider, "phi", "drive.velocity")
    return figure_of(plot_boundary, curve) if curve.sizes["point"] else None
