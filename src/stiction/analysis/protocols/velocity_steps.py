"""Velocity steps: direct effect, evolution, and the distance over which friction evolves."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, isnan, log, nan

import numpy as np

from stiction.analysis.protocols.friction_test import (
    ConstantStretch,
    FrictionTest,
    alike,
    friction_test,
)
from stiction.analysis.protocols.inversion.fit import Inversion
from stiction.analysis.protocols.inversion.law_choice import FittedLaw, choose
from stiction.analysis.protocols.inversion.rig_and_clock import say_rig_and_clock
from stiction.analysis.protocols.inversion.spring_slider import Law, SpringSlider
from stiction.analysis.protocols.inversion.step import StepData
from stiction.analysis.protocols.steady_levels import SteadyLevels, TravelTrend, steady_levels
from stiction.analysis.protocols.step_findings import VelocityStep, VelocitySteps
from stiction.analysis.record import Record
from stiction.drive import DriveProgram
from stiction.errors import ResultError
from stiction.text.lists import in_list, say_left_out
from stiction.text.quantity.wording import in_words
from stiction.trajectory import Trajectory

STILL_LOADED = "The mass does not slide before the step"
UNSETTLED = "Friction has not settled before the step"
FEW_SAMPLES = "There are too few samples before or after the step"
FARTHER = (
    "Let it slide farther before a step, by a longer distance in st.protocols.velocity_steps; a "
    "run may also begin in steady sliding, by its initial state."
)
REMEDIES = {STILL_LOADED: FARTHER, UNSETTLED: FARTHER, FEW_SAMPLES: "Raise the sample rate."}
Jumps = Sequence[tuple[ConstantStretch, ConstantStretch]]


def velocity_steps(
    source: Trajectory | Record, program: DriveProgram | None = None, *, law: Law | None = None
) -> VelocitySteps:
    """Return a - b, a, b and D_c from the jumps of a velocity-step test.

    Steady friction is mu = mu* + (a - b) ln(V/V*), which the levels before and after a jump show.
    a, b and D_c are those of the law whose curve, on a spring of the rig's stiffness, fits best
    to friction since the jump: a joint inversion (Reinen & Weeks 1993, doi:10.1029/93JB00780).
    On a stiff rig friction jumps by a ln(V_2/V_1), and evolves with the slip x as
    b ln[1 + (V_2/V_1 - 1) exp(-x/D_c)] by the ageing law, as b ln(V_2/V_1) exp(-x/D_c) by the slip
    law (Ruina 1983, doi:10.1029/JB088iB12p10359).

    The law of a run is known. To a record the ageing law and the slip law are fitted; the text says
    which fits better, or that the points do not tell, and then the table has both. Of a record the
    time of each step is fitted, too, within 5 % of a stretch or a sample, and the stiffness, within
    a factor of 1.5: the errors include what is not known of both, and the text says where the
    points show another stiffness than that stated, or steps that come earlier or later. Where the
    spring takes up the jump within a sample, the step may have come anywhere between two samples.

    Friction of rock often changes with the travel, too: by wear, by gouge. The settled parts of all
    stretches of a record show a slope that they have in common, and levels and curves are freed of
    it; a - b is that of both levels at the jump. Where the slope cannot be told from an evolution
    over a distance as long as the stretches, errors include that. A run has no trend.

    Errors are standard errors. They include that neighbouring residuals deviate together, and where
    a curve misses the points, how far off the parameters of a wrong law are. Parameters known to no
    more than a fifth are NaN, "none" in the text. So are those of a rig of unknown stiffness.

    Only jumps from one constant speed to another under a constant load count. Ramps, harmonics and
    recorded pieces, and jumps next to them, are left out.

    Parameters
    ----------
    source : Trajectory or Record
        A run, or a record with its normal load, and its stiffness, without which a - b alone is
        determined.
    program : DriveProgram, optional
        The program of a record, see `st.protocols.velocity_steps`; by default the steps are those
        of its measured `drive_position`. That of a run is known.
    law : {"ageing", "slip", "perrin"}, optional
        The law to be fitted; by default that of the run, or both of ageing and slip.

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
    levels = steady_levels(test)
    for one, two in test.successions():
        if one.velocity * two.velocity > 0.0 and not alike(one.velocity, two.velocity):
            why = _fault(test, one, two, levels.trend)
            if not why:
                jumps.append((one, two))
            faults.append((in_words(two.start, "s"), why))
    left_out = [*_varying(test), *say_left_out(each for each in faults if each[1])]
    if not jumps:
        raise ResultError(_refusal([why for _, why in faults], left_out))
    data = [step_data(test, levels, *jump) for jump in jumps]
    choice = choose(test, data, law)
    steps = _steps(test, levels, jumps, data, choice.best)
    other = () if choice.other is None else _steps(test, levels, jumps, data, choice.other)
    stiffness = _least_stiffness(test, jumps, steps)
    drive = "the displacement of the drive" if program is None else "the program"
    fitted = (*choice.said, *say_rig_and_clock(data, choice.best.steps, drive))
    return VelocitySteps(steps, stiffness, tuple(left_out), other, fitted, *levels.trend)


def _refusal(faults: Sequence[str], left_out: Sequence[str]) -> str:
    """Return why no step shows a friction law, and how one would."""
    if not faults:
        missing = "the speed of the drive does not step from one constant value to another"
        return " ".join([f"{missing}; see st.protocols.velocity_steps.", *left_out])
    remedies = dict.fromkeys(REMEDIES[why] for why in faults if why in REMEDIES)
    return " ".join(["no step shows a friction law.", *left_out, *remedies])


def _least_stiffness(test: FrictionTest, jumps: Jumps, steps: Sequence[VelocityStep]) -> float:
    """Return the least k D_c/(b W) of all steps, NaN if it is unknown."""
    known = [
        test.stiffness * each.stiffness_ratio * each.D_c / (two.load * abs(each.b))
        for each, (_, two) in zip(steps, jumps, strict=True)
        if not isnan(each.D_c)
    ]
    return min(known, default=nan)


def _varying(test: FrictionTest) -> list[str]:
    """Return a sentence about the times in which velocity or load vary, if there are any."""
    gaps = test.gaps()
    if not gaps:
        return []
    times = in_list([f"from {in_words(a, 's')} to {in_words(b, 's')}" for a, b in gaps])
    return [f"Velocity or load vary {times}: such changes, and jumps beside them, are left out."]


def _fault(
    test: FrictionTest, one: ConstantStretch, two: ConstantStretch, trend: TravelTrend
) -> str:
    """Return why a jump of the velocity shows no friction law; empty if it does."""
    if not alike(one.load, two.load):
        return "The load jumps with the velocity"
    if not test.is_sampled(one) or not test.is_sampled(two):
        return FEW_SAMPLES
    if not test.slides(one):
        return STILL_LOADED
    if not test.slides(two):
        return "The mass does not slide after the step"
    if not test.has_settled(one, trend.known_slope):
        return UNSETTLED
    return ""


def step_data(
    test: FrictionTest, levels: SteadyLevels, one: ConstantStretch, two: ConstantStretch
) -> StepData:
    """Return a step of the drive, from one stretch to the next, as it is fitted: without trend."""
    clock = test.clock_at_jump(one, two)
    way, around, late = one.way, test.until_end(two, clock), test.surely_late(one)
    rig = SpringSlider(
        two.velocity / one.velocity,
        test.stiffness / two.load,
        test.damping * abs(two.velocity) / two.load,
    )
    slope, error = levels.trend
    since, before = test.time[around] - two.start, abs(one.velocity) * (test.time[late] - one.end)
    travel = np.where(since < 0.0, abs(one.velocity), abs(two.velocity)) * since
    return StepData(
        two.start,
        rig,
        abs(two.velocity) * since,
        way * test.mu[around] - slope * travel,
        way * test.mu[late] - slope * before,
        levels.at_jump(two, two.start),
        test.off / two.load,
        float(before.mean()),
        error,
        abs(two.velocity),
        abs(two.velocity) * clock,
        abs(two.velocity) * test.error_of_jump(one, two),
    )


def _steps(
    test: FrictionTest,
    levels: SteadyLevels,
    jumps: Jumps,
    data: Sequence[StepData],
    fitted: FittedLaw,
) -> tuple[VelocityStep, ...]:
    """Return all steps with the fit of a law."""
    each = zip(jumps, data, fitted.steps, strict=True)
    return tuple(_step(test, levels, *jump, step, fitted.law, fit) for jump, step, fit in each)


def _step(
    test: FrictionTest,
    levels: SteadyLevels,
    one: ConstantStretch,
    two: ConstantStretch,
    data: StepData,
    law: Law,
    fit: Inversion,
) -> VelocityStep:
    """Return a step with the fit of a law."""
    before, by = levels.at_jump(one, two.start), log(data.rig.ratio)
    settled = test.has_settled(two, levels.trend.known_slope)
    steady = data.after if settled else nan
    lag = test.lag[test.until_end(two)]
    after = slice(len(data.slip) - len(lag), None)
    slip = data.slip[after]
    trend = levels.trend.slope * slip
    return VelocityStep(
        two.start,
        abs(one.velocity),
        abs(two.velocity),
        before,
        steady,
        data.up * float((data.up * data.mu).max()),
        fit.a,
        fit.b,
        (steady - before) / by,
        fit.D_c,
        fit.D_c_error,
        slip - one.way * (lag - lag[0]) * exp(-fit.stiffer),
        data.mu[after] + trend,
        fit.fit[after] + trend,
        fit.a_error,
        fit.b_error,
        law,
        levels.error_of_difference(one, two) / abs(by) if settled else nan,
        levels.trend.error * levels.apart(one, two) / by,
        fit.delay / data.speed,
        fit.delay_error / data.speed,
        exp(fit.stiffer),
        fit.stiffer_error * exp(fit.stiffer),
    )
