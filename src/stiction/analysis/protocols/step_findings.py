"""Direct effect and evolution of velocity steps, as values and in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, isnan, nan
from typing import NamedTuple

import numpy as np

from stiction.analysis.protocols.common_mean import common_mean
from stiction.analysis.protocols.inversion.spring_slider import Law
from stiction.analysis.protocols.steady_levels import TravelTrend
from stiction.analysis.signals.correlated_noise import ERRORS_95
from stiction.arrays import Floats, ShortRepr
from stiction.text.lists import coefficient_texts, in_list
from stiction.text.quantity.wording import in_words, to_error, with_error
from stiction.text.sections import Section, SectionReport, Table

# k D_c/(b W): below it the spring takes up a hundredth of a jump, b W/(k D_c), or more
STIFF = 100.0


@dataclass(frozen=True, repr=False)
class VelocityStep(ShortRepr):
    """One jump of the drive's velocity.

    Attributes
    ----------
    time : float
        s.
    before, after : float
        Velocities, m/s.
    steady_before, steady_after, peak : float
        Steady friction on both sides, and its extremum just after the jump, all with the trend as
        it is at the jump. Friction that has not settled after it is NaN, and so is a - b.
    a, b : float
        Direct effect and evolution effect, from the fit of the whole rig; NaN if not determined.
    a_minus_b : float
        Change of steady friction over the logarithm of the ratio of speeds.
    D_c, D_c_error : float
        Distance over which friction evolves, with its standard error, m; NaN if not
        determined.
    slip, mu, fit : ndarray
        (m,), slip since the jump (m), friction as measured, and the fitted curve with the trend;
        NaN without a fit.
    a_error, b_error : float
        Standard errors.
    law : {"ageing", "slip", "perrin"}
        Whose curve is fitted.
    a_minus_b_error : float
        Standard error; NaN if a single sample shows steady friction on one side.
    trend_share : float
        Part of that error, with its sign, by the trend that all steps have in common.
    delay, delay_error : float
        By how much the step comes later than `time`, s, from the same fit, and its standard error;
        0 for a run, or without a fit.
    stiffness_ratio, stiffness_ratio_error : float
        Stiffness of the rig over that stated, likewise; 1 for a run, or without a fit.
    """

    time: float
    before: float
    after: float
    steady_before: float
    steady_after: float
    peak: float
    a: float
    b: float
    a_minus_b: float
    D_c: float
    D_c_error: float
    slip: Floats
    mu: Floats
    fit: Floats
    a_error: float = nan
    b_error: float = nan
    law: Law = "ageing"
    a_minus_b_error: float = nan
    trend_share: float = 0.0
    delay: float = 0.0
    delay_error: float = 0.0
    stiffness_ratio: float = 1.0
    stiffness_ratio_error: float = 0.0


@dataclass(frozen=True, repr=False)
class VelocitySteps(SectionReport, ShortRepr):
    """The jumps of a velocity-step test.

    Attributes
    ----------
    steps : tuple of VelocityStep
        In order of time.
    stiffness : float
        k D_c/(b W), the least of all steps: how stiff the rig is; NaN if unknown.
    left_out : tuple of str
        Which changes of the velocity are left out, and why, in sentences.
    other : tuple of VelocityStep
        The same steps with the fit of another law, where the points do not tell which is right.
    fitted : tuple of str
        Which law is fitted, and where its parameters are not determined, in sentences.
    trend, trend_error : float
        Change of friction with the travel of the drive, which all steps are freed of, and its
        standard error, 1/m; zero for a run, which has none.
    """

    _figure = "plot_velocity_steps"

    steps: tuple[VelocityStep, ...]
    stiffness: float
    left_out: tuple[str, ...] = ()
    other: tuple[VelocityStep, ...] = ()
    fitted: tuple[str, ...] = ()
    trend: float = 0.0
    trend_error: float = 0.0

    @property
    def answer(self) -> str:
        """How steady friction depends on speed, and over which distance it evolves."""
        laws = [_distance(each) for each in (self.steps, self.other)]
        either = f"; D_c = {' or '.join(filter(None, laws))}." if any(laws) else "."
        return f"{self._a_minus_b().removesuffix('.')}{either}"

    @property
    def section(self) -> Section:
        """The steps in words and as a table."""
        sentences = [self._a_minus_b(), *self._trend(), *self.fitted, *self._differing()]
        if self.stiffness < STIFF:
            sentences.append(
                f"The rig is not stiff, k D_c/(b W) = {self.stiffness:.3g}: its spring shapes the "
                "curves."
            )
        sentences += self.left_out
        rows = [_row(each) for each in (*self.steps, *self.other)]
        return Section("Velocity steps", sentences, Table(HEADINGS, rows))

    def _a_minus_b(self) -> str:
        """Return how steady friction depends on speed, in a sentence."""
        known = [each for each in self.steps if not isnan(each.a_minus_b)]
        if not known:
            return "Friction has not settled after any step: a - b is not known."
        mean, error, alike = common_value(known)
        way = "depends on speed in an unknown way"
        if abs(mean) > ERRORS_95 * error:
            way = f"{'weakens' if mean < 0.0 else 'strengthens'} with speed"
        elif not alike:
            way = "depends on speed differently from step to step"
        elif not isnan(error):
            way = "does not depend on speed beyond its error"
        steps = "one step" if len(known) == 1 else f"{len(known)} steps"
        few = f" of {steps}: after the others it has not settled"
        where = few if len(known) < len(self.steps) else ""
        value = f"{'+' if mean > 0.0 else ''}{with_error(mean, error, '')}"
        return f"Steady friction {way}: a - b = {value} on average{where}."

    def _differing(self) -> list[str]:
        """Return the fitted parameters that differ from step to step, in a sentence, if any do."""
        names = [name for name in ("a", "b", "D_c") if not _alike(self.steps, name)]
        if not names:
            return []
        verb = "differ" if len(names) > 1 else "differs"
        return [
            f"{in_list(names)} {verb} from step to step by more than the errors: a curve has no "
            "inertia, and one law may not hold at all speeds."
        ]

    def _trend(self) -> list[str]:
        """Return how friction changes with the travel, in a sentence, if it does."""
        if not TravelTrend(self.trend, self.trend_error).stands_out:
            return []
        way = "rises" if self.trend > 0.0 else "falls"
        by = f"{with_error(1e-3 * abs(self.trend), 1e-3 * self.trend_error, '')} per mm of travel"
        return [f"Friction {way} by {by}: the steps are freed of this trend."]


class CommonValue(NamedTuple):
    """The mean of a - b over all steps, its standard error, and whether the steps agree."""

    value: float
    error: float
    alike: bool


def common_value(steps: Sequence[VelocityStep]) -> CommonValue:
    """Return the mean of a - b, weighted by errors; where steps differ, so says its error.

    The trend is common to all: one more unknown, zero within its error.
    """
    sure = [each for each in steps if not isnan(each.a_minus_b_error)] or steps
    values = np.array([each.a_minus_b for each in sure])
    errors = np.array([each.a_minus_b_error for each in sure])
    shares = np.array([each.trend_share for each in sure])
    own = np.sqrt(np.maximum(errors**2 - shares**2, 0.0))
    if not own.max() > 0.0:  # a run, or unknown
        return CommonValue(float(values.mean()), hypot(own.max(), float(shares.mean())), True)
    # steady friction between two steps counts in both
    found = common_mean(values, own, shares, times=min(len(sure), 2))
    return CommonValue(found.value, found.scaled_error, found.alike)


def _distance(steps: Sequence[VelocityStep]) -> str:
    """Return the mean of D_c with its law, or its range where steps differ; "" without any."""
    values, errors = _known_values(steps, "D_c")
    if not len(values):
        return ""
    if _alike(steps, "D_c"):
        found = common_mean(values, errors)
        text = with_error(found.value, found.safe_error, "m")
    else:
        text = f"{in_words(values.min(), 'm', 2)} to {in_words(values.max(), 'm', 2)}"
    return f"{text} ({steps[0].law} law)"


def _known_values(steps: Sequence[VelocityStep], name: str) -> Floats:
    """Return the known values of a fitted parameter, and their errors, (2, n)."""
    pairs = np.array([(getattr(each, name), getattr(each, f"{name}_error")) for each in steps])
    found: Floats = pairs.reshape(-1, 2)[np.isfinite(pairs).all(axis=-1)].T
    return found


def _alike(steps: Sequence[VelocityStep], name: str) -> bool:
    """Return whether a fitted parameter is the same in all steps, within its errors."""
    values, errors = _known_values(steps, name)
    return len(values) < 2 or not errors.all() or common_mean(values, errors).alike


HEADINGS = ("from", "to", "a - b", "±", "law", "a", "±", "b", "±", "D_c", "±")


def _row(step: VelocityStep) -> tuple[str, ...]:
    """Return the row of a step in the table."""
    return (
        in_words(step.before, "m/s"),
        in_words(step.after, "m/s"),
        *coefficient_texts(step.a_minus_b, step.a_minus_b_error, "+"),
        "none" if isnan(step.D_c) else step.law,
        *coefficient_texts(step.a, step.a_error),
        *coefficient_texts(step.b, step.b_error),
        to_error(step.D_c, step.D_c_error, "m"),
        in_words(step.D_c_error, "m", 1),
    )
