"""What the curves of a record's steps say of its rig and its clock, in sentences."""

from __future__ import annotations

from collections.abc import Sequence
from math import expm1, isnan, log, sqrt

import numpy as np

from stiction.analysis.protocols.inversion.fit import Inversion
from stiction.analysis.protocols.inversion.step import StepData, onset
from stiction.arrays import Floats
from stiction.text.lists import in_list, number_text
from stiction.text.units import in_words

SURE = 3.0  # standard errors beyond which a stiffness is not as stated, a step not when stated
ALIKE = log(1.02)  # stiffnesses that are so near to each other are not worth a sentence


def say_rig_and_clock(steps: Sequence[StepData], fits: Sequence[Inversion]) -> list[str]:
    """Return how far stiffness and times of the steps are from those stated, where they are."""
    pairs = [(step, fit) for step, fit in zip(steps, fits, strict=True) if step.clock > 0.0]
    said = _say_clock([step for step, fit in pairs if isnan(fit.D_c)])
    known = [(step, fit) for step, fit in pairs if not isnan(fit.D_c)]
    if not known:
        return said
    stiffer = np.array([(fit.stiffer, fit.stiffer_error) for _, fit in known])
    late = np.array([(fit.delay / step.speed, fit.delay_error / step.speed) for step, fit in known])
    interval = max(step.interval for step, _ in known)
    return [*_say_stiffness(*_mean(stiffer)), *_say_delay(late, interval), *said]


def _say_clock(steps: Sequence[StepData]) -> list[str]:
    """Return that friction changes at other times than steps do, where no curve was fitted."""
    late = [float(each.slip[onset(each, each.mu)]) / each.speed for each in steps]
    far = [
        f"{in_words(by, 's', 2)} after the step at {in_words(step.time, 's')}"
        for step, by in zip(steps, late, strict=True)
        if by * step.speed > step.clock
    ]
    if not far:
        return []
    return [
        f"Friction begins to change {in_list(far)}: is t = 0 of the program that of the record? "
        "Add to the record's times what is missing."
    ]


def _say_stiffness(by: float, error: float) -> list[str]:
    """Return that a rig is stiffer or softer than stated, if it surely is."""
    if abs(by) < max(SURE * error, ALIKE):
        return []
    share, way = 100.0 * abs(expm1(by)), "stiffer" if by > 0.0 else "softer"
    off = number_text(100.0 * error, ".1g")
    return [
        f"By the curves the rig is {share:.2g} % {way} than stated, ± {off} %: a, b and D_c are "
        "those with that stiffness."
    ]


def _say_delay(late: Floats, interval: float) -> list[str]:
    """Return that steps come earlier or later than stated, if they do by more than a sample."""
    mean, error = _mean(late)
    if abs(mean) < max(SURE * error, interval):
        return []
    way, by = "later" if mean > 0.0 else "earlier", in_words(abs(mean), "s", 2)
    off = in_words(error, "s", 1)
    return [f"The steps come {by} {way} than the program has them, ± {off} on average."]


def _mean(values: Floats) -> tuple[float, float]:
    """Return the weighted mean of values with errors (n, 2), and its error, also by scatter."""
    weights = values[:, 1] ** -2.0
    mean = float(np.average(values[:, 0], weights=weights))
    scatter = float(weights @ (values[:, 0] - mean) ** 2) / max(len(values) - 1, 1)
    return mean, sqrt(max(scatter, 1.0) / float(weights.sum()))
