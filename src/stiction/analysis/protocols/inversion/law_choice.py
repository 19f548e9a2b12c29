"""The rate-and-state law of a test's steps: fits of each law, and the choice between them."""

from __future__ import annotations

from collections.abc import Sequence
from math import isnan
from typing import NamedTuple

from stiction.analysis.protocols.friction_test import FrictionTest
from stiction.analysis.protocols.inversion.fit import Inversion, invert, unknown
from stiction.analysis.protocols.inversion.spring_slider import Law
from stiction.analysis.protocols.inversion.step import StepData
from stiction.friction.laws import RateStateAgeing2, RateStateSlip2
from stiction.text.lists import in_list
from stiction.text.quantity.wording import in_words

CERTAIN = 13.8  # difference of sums of squares, in variances: likelihoods differ by a thousand
LAWS: dict[str, Law] = {
    "RateStateAgeing": "ageing",
    "RateStateSlip": "slip",
    "RateStatePerrin": "perrin",
}
NAMES: dict[Law, str] = {
    "ageing": "ageing law",
    "slip": "slip law",
    "perrin": "law of Perrin, Rice & Zheng",
}
NEITHER = (
    "Neither the ageing law nor the slip law is that of all steps; give law to fit one of them."
)
TWO_STATES = "The law of the run has two states; a law with one is fitted."
UNDECIDED = "The points do not tell the ageing law from the slip law: the table has both."
UNKNOWN_RIG = (
    "The stiffness of the rig is not known: a, b and D_c are not determined. Give the record its "
    "stiffness, also if it is large."
)


class FittedLaw(NamedTuple):
    """A law, and its fit to each step."""

    law: Law
    steps: list[Inversion]

    @property
    def known(self) -> bool:
        """Whether a, b and D_c of any step are determined."""
        return any(not isnan(each.D_c) for each in self.steps)

    @property
    def misses(self) -> bool:
        """Whether no curve of the law goes through the points of some step."""
        return any(each.misses and isnan(each.D_c) for each in self.steps)


class LawChoice(NamedTuple):
    """The best-fitting law; a second law, if the points do not decide; sentences."""

    best: FittedLaw
    other: FittedLaw | None
    said: list[str]


def choose(test: FrictionTest, steps: Sequence[StepData], law: Law | None) -> LawChoice:
    """Fit the law of a run, or one that is asked for; to a record both ageing law and slip law."""
    own = LAWS.get(type(test.law).__name__)
    if isnan(test.stiffness):
        nothing = FittedLaw(law or own or "ageing", [unknown(len(each.mu)) for each in steps])
        return LawChoice(nothing, None, [UNKNOWN_RIG])
    if alone := law or own:
        fit = _fit(steps, alone)
        return LawChoice(fit, None, [_why(alone, own), *_reasons(steps, fit)])
    chosen = _better(steps, _fit(steps, "ageing"), _fit(steps, "slip"))
    if isinstance(test.law, RateStateAgeing2 | RateStateSlip2):
        return chosen._replace(said=[TWO_STATES, *(x for x in chosen.said if x != NEITHER)])
    return chosen


def _fit(steps: Sequence[StepData], law: Law) -> FittedLaw:
    """Return the fit of a law to each step."""
    return FittedLaw(law, [invert(each, law) for each in steps])


def _why(law: Law, own: Law | None) -> str:
    """Return why only one law is fitted, in a sentence; `own` is the run's law."""
    why = "which is that of the run" if law == own else "as asked"
    if own and law != own:
        why = f"though the run has the {NAMES[own]}"
    return f"Fitted: the {NAMES[law]}, {why}."


def _better(steps: Sequence[StepData], one: FittedLaw, two: FittedLaw) -> LawChoice:
    """Return the better-fitting of two laws, as far as the points decide."""
    gain = _gain(one, two)
    best, other = (one, two) if gain >= 0.0 else (two, one)
    reasons = _reasons(steps, best)
    if best.misses:
        nothing = best._replace(steps=[unknown(len(each.mu)) for each in steps])
        return LawChoice(nothing, None, [*reasons[:1], NEITHER])
    if not (best.known or other.known):
        return LawChoice(best, None, reasons)
    if abs(gain) > CERTAIN or gain == 0.0:
        better = f"Fitted: the {NAMES[best.law]}; the other of ageing law and slip law fits worse."
        return LawChoice(best, None, [better, *reasons])
    return LawChoice(best, other, [UNDECIDED, *reasons])


def _gain(one: FittedLaw, two: FittedLaw) -> float:
    """Return by how much one law fits better than another: sums of squares over the variance."""
    gain = 0.0
    for first, second in zip(one.steps, two.steps, strict=True):
        if not isnan(first.square) and not isnan(second.square):
            variance = (first if first.square < second.square else second).variance
            gain += (second.square - first.square) / variance
    return gain


def _reasons(steps: Sequence[StepData], fit: FittedLaw) -> list[str]:
    """Return sentences on why a, b and D_c of some steps are not determined."""
    found = []
    for misses, why in (
        (True, "No curve of the law goes through the points"),
        (False, "The points show too little of an evolution of friction"),
    ):
        times = [
            in_words(step.time, "s")
            for step, each in zip(steps, fit.steps, strict=True)
            if isnan(each.D_c) and each.misses == misses
        ]
        if times:
            found.append(f"{why}: a, b and D_c are not determined at {in_list(times)}.")
    return found
