"""The whole audit of an apparatus: predicted, simulated, and what to change."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from stiction.auditing.advice import LEVERS, Advice, advise, limits
from stiction.auditing.observation import Observation, coarse_rate, observe
from stiction.auditing.prediction import Prediction, predict
from stiction.linear_stability import Critical, Linearisation, critical, steady_sliding
from stiction.slider import Slider


class Audit(NamedTuple):
    """All that an experimenter wants to know before a friction test is trusted.

    Parameters
    ----------
    slider : Slider
        The apparatus.
    prediction : Prediction
        What theory says from the description alone.
    sliding : Linearisation
        Steady sliding and its modes.
    misalignment : Critical
        Where steady sliding changes between unstable and stable as phi grows.
    observation : Observation
        The simulated test.
    advices : tuple of Advice
        What would make it slide steadily, each tried; none if it does.
    """

    slider: Slider
    prediction: Prediction
    sliding: Linearisation
    misalignment: Critical
    observation: Observation
    advices: tuple[Advice, ...]


def examine(slider: Slider, progress: Callable[[float], None] | None = None) -> Audit:
    """Audit an apparatus.

    Parameters
    ----------
    slider : Slider
        With a steady drive and load.
    progress : callable, optional
        Called with the fraction done.

    Raises
    ------
    DescriptionError
        If drive or load are not steady.
    StictionError
        If friction comes to no steady sliding.
    """

    def report(done: int) -> None:
        if progress is not None:
            progress(done / (len(LEVERS) + 1))

    sliding, prediction = steady_sliding(slider), predict(slider)
    growth = sliding.growth_rate
    rate = max(prediction.sample_rate, coarse_rate(prediction))
    observation = observe(slider, prediction, growth, sample_rate=rate)
    report(1)
    advices = []
    if not sliding.stable:
        for advice in advise(slider):
            advices.append(advice)
            report(1 + len(advices))
    misalignment = critical(slider, "phi", limits(slider, "phi"))
    return Audit(slider, prediction, sliding, misalignment, observation, tuple(advices))
