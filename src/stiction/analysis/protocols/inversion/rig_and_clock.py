"""Errors of the rig's stiffness and of the clock that a record's steps show, in sentences."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, expm1, inf, isnan, log

import numpy as np

from stiction.analysis.protocols.common_mean import CommonMean, common_mean
from stiction.analysis.protocols.inversion.fit import Inversion
from stiction.analysis.protocols.inversion.step import StepData, has_changed, jumps_at_once, onset
from stiction.analysis.signals.correlated_noise import ERRORS_997
from stiction.text.lists import in_list, number_text
from stiction.text.quantity.wording import advice, in_words

SAMPLES = 20.0  # while friction evolves by D_c: with fewer the time of a step matters
ALIKE_STIFFNESSES = log(1.02)  # stiffnesses that are so near to each other are not worth a sentence


def say_rig_and_clock(
    steps: Sequence[StepData], fits: Sequence[Inversion], drive: str
) -> list[str]:
    """Return the deviations of the steps' stiffness and times from the stated ones, if any.

    The `drive` says what tells the times of the steps: "the program", "the displacement of the
    drive".
    """
    pairs = [(step, fit) for step, fit in zip(steps, fits, strict=True) if step.clock > 0.0]
    said = _say_clock([step for step, fit in pairs if isnan(fit.D_c)], drive)
    known = [(step, fit) for step, fit in pairs if not isnan(fit.D_c)]
    if not known:
        return said
    stiffer = [(fit.stiffer, fit.stiffer_error) for _, fit in known]
    late = [(fit.delay / step.speed, fit.delay_error / step.speed) for step, fit in known]
    interval = max(step.interval for step, _ in known)
    of_stiffness, of_delay = (common_mean(*np.array(each).T) for each in (stiffer, late))
    said = [*_say_stiffness(of_stiffness), *_say_delay(of_delay, interval, drive), *said]
    return [*said, *_say_sampling(known)]


def _say_sampling(known: Sequence[tuple[StepData, Inversion]]) -> list[str]:
    """Return that samples are few for a step that may lie anywhere between two of them."""
    unseen = [pair for pair in known if not pair[0].shows_jump and jumps_at_once(pair[0])]
    wanted = max((SAMPLES * step.speed / fit.D_c for step, fit in unseen), default=0.0)
    rate = min((1.0 / step.interval for step, _ in unseen), default=inf)
    if wanted <= rate:
        return []
    return [
        f"Steps may lie anywhere between two samples, at {in_words(rate, 'Hz')}: a and b of all "
        "of them may be too small, or too large, by their errors. Sample at "
        f"{advice(wanted, 'Hz')}, or measure the displacement of the drive."
    ]


def _say_clock(steps: Sequence[StepData], drive: str) -> list[str]:
    """Return that friction changes at other times than steps do, where no curve was fitted."""
    found = [(each, onset(each, each.mu)) for each in steps]
    late = [
        f"{in_words(float(step.slip[at]) / step.speed, 's', 2)} after {drive} has the step at "
        f"{in_words(step.time, 's')}"
        for step, at in found
        if float(step.slip[at]) > step.clock
    ]
    early = [in_words(step.time, "s") for step, at in found if at == 0 and has_changed(step)]
    said = []
    if late:
        said.append(f"Friction begins to change {in_list(late)}: are both on one clock?")
    if early:
        said.append(
            f"Friction has changed before {drive} has the step at {in_list(early)}: are both on "
            "one clock?"
        )
    return said


def _say_stiffness(found: CommonMean) -> list[str]:
    """Return that a rig is stiffer or softer than stated, if it surely is."""
    by, error = found.value, found.safe_error
    if abs(by) < max(ERRORS_997 * error, ALIKE_STIFFNESSES):
        return []
    share, way = 100.0 * abs(expm1(by)), "stiffer" if by > 0.0 else "softer"
    off = number_text(100.0 * exp(by) * error, ".1g")
    return [
        f"By the curves the rig is {share:.2g} % {way} than stated, ± {off} %: a, b and D_c are "
        "those with that stiffness."
    ]


def _say_delay(late: CommonMean, interval: float, drive: str) -> list[str]:
    """Return that steps come earlier or later than stated, if they do by more than a sample."""
    mean, error = late.value, late.safe_error
    if abs(mean) < max(ERRORS_997 * error, interval):
        return []
    way, by = "later" if mean > 0.0 else "earlier", in_words(abs(mean), "s", 2)
    return [f"The steps come {by} {way} than {drive} has them, ± {in_words(error, 's', 1)}."]
