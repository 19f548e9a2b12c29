"""The loading rate that a load cell measures, as a function of a plan's parameters."""

from __future__ import annotations

import numpy as np
from scipy.special import ndtr

from stiction.arrays import TINY, Floats
from stiction.inference.priors import Prior
from stiction.inference.simulated.plan import Plan
from stiction.inference.simulated.synthetic import NOT_OF_THE_SLIDER
from stiction.system.parameter import change_unchecked
from stiction.system.slider import Slider

SCORES = np.linspace(-4.0, 4.0, 17)  # between which the logarithm of a rate is interpolated


def loading_rate(slider: Slider) -> float:
    """Return the rate of the force along the drive while the mass is at rest, k_x V, in N/s.

    >>> import stiction as st
    >>> loading_rate(st.presets.nakano_popov_2020())
    1.0
    """
    return slider.k_x * slider.drive_speed


def logarithms_of_rate(plan: Plan, scores: Floats) -> Floats:
    """Return logarithms of the measured loading rate over that at the priors' medians, (n,).

    The rigs have these normal scores (n, p) of their parameters; the cell's gain counts.
    """
    total = np.zeros(len(scores))
    for column, (name, prior) in zip(scores.T, plan.priors.items(), strict=True):
        total += np.interp(column, SCORES, _course(plan.slider, name, prior))
    return total


def _course(slider: Slider, name: str, prior: Prior) -> Floats:
    """Return the logarithm of the rate over a slider's rate, at `SCORES` of one parameter."""
    values = prior.quantile(ndtr(SCORES))
    if name == "gain":
        return np.asarray(np.log(np.maximum(values, TINY)))
    if name in NOT_OF_THE_SLIDER:
        return np.zeros_like(values)
    rates = [loading_rate(change_unchecked(slider, name, its)) for its in values.tolist()]
    return np.asarray(np.log(np.maximum(rates, TINY) / loading_rate(slider)))
