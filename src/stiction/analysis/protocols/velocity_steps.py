"""Velocity steps: direct effect, evolution, and the distance over which friction evolves."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isnan, nan
from typing import Literal

import numpy as np

from stiction.analysis.protocols.friction_test import (
    ConstantStretch,
    FrictionTest,
    alike,
    friction_test,
    in_list,
    number_text,
    say_left_out,
)
from stiction.analysis.record import Record
from stiction.arrays import Floats
from stiction.drive import DriveProgram
from stiction.errors import ResultError
from stiction.text.sections import Section, Table
from stiction.text.units import in_words
from stiction.trajectory import Trajectory

Law = Literal["slip", "ageing"]
SHOWN = 10.0  # D_c of slip that a fit looks at, at most
FEWEST_SAMPLES = 8  # samples of a fit
STIFF = 300.0  # k D_c/(b W) above which D_c is found to 2 %


@dataclass(frozen=True)
class VelocityStep:
    """One jump of the drive's velocity.

    Attributes
    ----------
    time : float
        s.
    before, after : float
        Velocities, m/s.
    steady_before, steady_after, peak : float
        Steady friction on both sides, and its extremum just after the jump. Friction that has not
        settled after it is NaN, and so is a - b.
    a, b : float
        Direct effect, from the extremum: a lower bound on a rig that is not stiff; evolution
        effect, from the fit.
    a_minus_b : float
        Change of steady friction over the logarithm of the ratio of speeds.
    D_c, D_c_error : float
        Distance over which friction evolves, with its standard error, m; NaN if it is not known.
    slip, mu, fit : ndarray
        (m,), slip since the jump (m), friction, and the fitted curve.
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


@dataclass(frozen=True)
class VelocitySteps:
    """The jumps of a velocity-step test.

    Attributes
    ----------
    steps : tuple of VelocityStep
        In order of time.
    stiffness : float
        k D_c/(b W), the least of all steps: how stiff the rig is; NaN if unknown.
    left_out : tuple of str
        Which changes of the velocity are left out, and why, in sentences.
    """

    steps: tuple[VelocityStep, ...]
    stiffness: float
    left_out: tuple[str, ...] = ()

    @property
    def section(self) -> Section:
        """The steps in words and as a table."""
        rows = [
            (
                in_words(each.before, "m/s"),
                in_words(each.after, "m/s"),
                number_text(each.a_minus_b, "+.4f"),
                number_text(each.a, ".4f"),
                number_text(each.b, ".4f"),
                in_words(each.D_c, "m"),
                in_words(each.D_c_error, "m", 1),
            )
            for each in self.steps
        ]
        sentences = [self._a_minus_b()]
        if self.stiffness < STIFF:
            sentences.append(
                f"The rig is not stiff, k D_c/(b W) = {self.stiffness:.3g}: a is a lower bound, "
                "and b and D_c are those of rig and friction together."
            )
        sentences += self.left_out
        headings = ("from", "to", "a - b", "a", "b", "D_c", "+-")
        return Section("Velocity steps", sentences, Table(headings, rows))

    def _a_minus_b(self) -> str:
        """Return how steady friction depends on speed, in a sentence."""
        known = [each.a_minus_b for each in self.steps if not isnan(each.a_minus_b)]
        if not known:
            return "Friction has not settled after any step: a - b is not known."
        mean = float(np.mean(known))
        way = "weakens" if mean < 0.0 else "strengthens"
        few = f" of {len(known)} steps: after the others it has not settled"
        where = few if len(known) < len(self.steps) else ""
        return f"Steady friction {way} with speed: a - b = {mean:+.4f} on average{where}."

    def __str__(self) -> str:
        """Return the section as text."""
        return str(self.section)


def velocity_steps(
    source: Trajectory | Record, program: DriveProgram | None = None, *, law: Law = "ageing"
) -> VelocitySteps:
    """Return a - b, a, b and D_c from the jumps of a velocity-step test.

    Steady friction is mu = mu* + (a - b) ln(V/V*). On a stiff rig friction jumps by a ln(V_2/V_1),
    and evolves with the slip x since the jump as b ln[1 + (V_2/V_1 - 1) exp(-x/D_c)] by the ageing
    law, as b ln(V_2/V_1) exp(-x/D_c) by the slip law (Ruina 1983, doi:10.1029/JB088iB12p10359),
    which is fitted. The rig is stiff where k D_c/W is far larger than a and b.

    Only jumps from one constant speed to another under a constant load count. Ramps, harmonics and
    recorded pieces, and jumps next to them, are left out.

    Parameters
    ----------
    source : Trajectory or Record
        A run, or a record with its normal load, and if possible its stiffness.
    program : DriveProgram, optional
        The program of a record, see `st.protocols.velocity_steps`; that of a run is known.
    law : {"ageing", "slip"}, optional
        The curve to be fitted.

    Raises
    ------
    ResultError
        If the drive's velocity does not jump from one constant speed to another.

    Examples
    --------
    >>> import stiction as st
    >>> law = st.laws.RateStateAgeing(mu_star=0.6, a=0.010, b=0.015, D_c="10 um", V_star="1 um/s")
    >>> test = st.protocols.velocity_steps(["1 um/s", "10 um/s"], distance="0.2 mm")
    >>> slider = st.Slider(
    ...     mass="1 g", k_x="1 MN/m", k_y="100 MN/m", phi="0 deg", normal_load="10 N",
    ...     friction=law, drive=test)
    >>> found = st.analysis.velocity_steps(st.simulate(slider, sample_rate="20 Hz"))
    >>> round(found.steps[0].a, 3), round(found.steps[0].b, 3)
    (0.01, 0.015)
    """
    test = friction_test(source, program)
    jumps, faults = [], []
    for one, two in test.successions():
        if one.velocity * two.velocity > 0.0 and not alike(one.velocity, two.velocity):
            why = _fault(test, one, two)
            if not why:
                jumps.append((one, two))
            faults.append((in_words(two.start, "s"), why))
    left_out = [*_varying(test), *say_left_out(each for each in faults if each[1])]
    if not jumps:
        missing = "the speed of the drive does not step from one constant value to another"
        raise ResultError(" ".join([f"{missing}; see st.protocols.velocity_steps.", *left_out]))
    steps = tuple(_step(test, one, two, law) for one, two in jumps)
    known = [
        test.stiffness * each.D_c / (two.load * abs(each.b))
        for each, (_, two) in zip(steps, jumps, strict=True)
        if each.b
    ]
    stiffness = float(np.nanmin(known)) if np.isfinite(known).any() else nan
    return VelocitySteps(steps, stiffness, tuple(left_out))


def _varying(test: FrictionTest) -> list[str]:
    """Return a sentence about the times in which velocity or load vary, if there are any."""
    gaps = test.gaps()
    if not gaps:
        return []
    times = in_list([f"from {in_words(a, 's')} to {in_words(b, 's')}" for a, b in gaps])
    return [f"Velocity or load vary {times}: such changes, and jumps beside them, are left out."]


def _fault(test: FrictionTest, one: ConstantStretch, two: ConstantStretch) -> str:
    """Return why a jump of the velocity shows no friction law; empty if it does."""
    if not alike(one.load, two.load):
        return "The load jumps with the velocity"
    if not test.is_sampled(one) or not test.is_sampled(two):
        return "There are too few samples before or after the step"
    if not test.slides(one):
        return "The mass does not slide before the step"
    if not test.slides(two):
        return "The mass does not slide after the step"
    if not test.has_settled(one):
        return "Friction has not settled before the step"
    return ""


def _step(test: FrictionTest, one: ConstantStretch, two: ConstantStretch, law: Law) -> VelocityStep:
    way = float(np.sign(one.velocity))
    after = test.within(two.start, two.end)
    mu, before, steady = way * test.mu[after], way * test.steady(one), nan
    if test.has_settled(two):
        steady = way * test.steady(two)
    ratio = two.velocity / one.velocity
    up = 1.0 if ratio > 1.0 else -1.0
    first = int((up * mu).argmax())
    lag = way * (test.lag[after] - test.lag[after[0]])
    slip = abs(two.velocity) * (test.time[after] - two.start) - lag
    b, D, error, fit = _evolution(slip[first:], mu[first:], ratio, law)
    peak, by = float(mu[first]), float(np.log(ratio))
    return VelocityStep(
        two.start,
        abs(one.velocity),
        abs(two.velocity),
        before,
        steady,
        peak,
        (peak - before) / by,
        b,
        (steady - before) / by,
        D,
        error,
        slip[first:],
        mu[first:],
        fit,
    )


def _evolution(
    slip: Floats, mu: Floats, ratio: float, law: Law
) -> tuple[float, float, float, Floats]:
    """Return b, D_c, its standard error (m), and the fitted curve."""
    from scipy.optimize import curve_fit

    def curve(x: Floats, end: float, b: float, log_D: float) -> Floats:
        fallen = np.exp(-x / np.exp(log_D))
        if law == "slip":
            return np.asarray(end + b * np.log(ratio) * fallen)
        return np.asarray(end + b * np.log1p((ratio - 1.0) * fallen))

    unknown = nan, nan, nan, np.full(len(mu), nan)
    change = mu[0] - mu[-1]
    if len(mu) < FEWEST_SAMPLES or change == 0.0:
        return unknown
    reached = np.flatnonzero(np.abs(mu - mu[0]) > (1.0 - np.exp(-1.0)) * abs(change))
    guess = slip[reached[0]] - slip[0] if len(reached) else slip[-1] - slip[0]
    if not guess > 0.0:
        return unknown
    near = slip - slip[0] <= SHOWN * guess if law == "slip" else slip <= inf
    start = (mu[-1], change / np.log(ratio), np.log(guess))
    try:
        found, covariance = curve_fit(curve, slip[near], mu[near], start)  # type: ignore[no-untyped-call]
    except RuntimeError:  # no least sum of squares
        return unknown
    D = float(np.exp(found[2]))
    return float(found[1]), D, D * float(np.sqrt(covariance[2, 2])), curve(slip, *found)
