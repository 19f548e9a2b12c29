"""The onset of an oscillation: soft and hard, against linear theory and the averaged equation."""

import math

import numpy as np
import pytest

import stiction as st
from stiction.analysis.onset import find_onset
from stiction.linear_stability import critical

PAPER = st.presets.nakano_popov_2020()
LAW = st.laws.Stribeck(mu_s=0.3, mu_c=0.15, v_s="20 mm/s")
W, V_S = 10.0, 0.02


def block(speed):
    """A mass on a belt: motion along one spring, with the damper that is critical."""
    slider = PAPER.replace(phi="0 deg", k_y=2e3, friction=LAW, drive=st.ConstantVelocity(speed))
    return slider, -LAW.slope(speed) * W


def third_derivative(speed):
    """F''' of F = W [mu_c + (mu_s - mu_c) exp(-x^2)], x = v/v_s; it changes sign at x^2 = 3/2."""
    x = speed / V_S
    return W * (LAW.mu_s - LAW.mu_c) * (12 * x - 8 * x**3) * math.exp(-x * x) / V_S**3


def test_the_onset_of_the_paper_is_soft():
    """Rest at 8.70 deg, oscillation at 8.64 deg, and at the critical angle no amplitude is left.

    The square of the amplitude is curved: a straight line through two points leaves of their
    distance what it changes by over it, about a tenth.
    """
    degrees = np.arange(8.58, 8.74, 0.02)
    found = find_onset(PAPER, "phi", [f"{each} deg" for each in degrees])
    assert found.kind == "soft"
    by_theory = critical(PAPER, "phi", ("8 deg", "9 deg")).values[0]
    assert math.degrees(found.threshold) == pytest.approx(math.degrees(by_theory), abs=0.002)
    outcome, growth = found.data["outcome"].values, found.data["growth_rate"].values
    decided = outcome < 2
    assert (decided.sum(axis=1) >= len(degrees) - 1).all()  # one may be too close to tell
    assert ((outcome == (growth > 0)) | ~decided).all()


@pytest.mark.parametrize("degrees", [(7, 8, 9, 10), (8.0, 8.25, 8.5, 8.75, 9.0)])
def test_coarse_values_are_refined(degrees):
    """Just below the onset the oscillation is a hundredth of what it is at 8 deg: more is run."""
    found = find_onset(PAPER, "phi", [f"{each} deg" for each in degrees])
    assert found.kind == "soft"
    by_theory = critical(PAPER, "phi", ("8 deg", "9 deg")).values[0]
    assert abs(found.threshold - by_theory) <= found.uncertainty <= math.radians(0.02)
    assert found.data.sizes["value"] > len(degrees)


def test_what_cannot_be_told_is_not_determined():
    """With too little time for each run nothing is decided near the onset."""
    degrees = ("8.5 deg", "8.65 deg", "8.66 deg", "8.8 deg")
    found = find_onset(PAPER, "phi", degrees, most_blocks=8)
    assert found.kind == "not determined"
    by_theory = critical(PAPER, "phi", ("8 deg", "9 deg")).values[0]
    assert abs(found.threshold - by_theory) <= found.uncertainty


def test_a_soft_onset_has_the_amplitude_of_the_averaged_equation():
    """Averaged over a period: c + F'(V) + F'''(V) a^2/8 = 0, a the amplitude of the rate.

    What is left out is of the order of a^2 over the squared scale of the law.
    """
    speed = 0.6 * V_S
    slider, c = block(speed)
    shares = np.array([0.985, 0.99, 0.995, 1.02, 1.05])
    found = find_onset(slider, "c_x", list(c * shares))
    assert found.kind == "soft"
    assert abs(found.threshold - c) <= found.uncertainty <= 5e-4 * c
    rate = found.data["amplitude"].values[:, :2] * math.sqrt(slider.k_x / slider.mass)
    expected = np.sqrt(8 * c * (1 - shares[:2]) / third_derivative(speed))
    left_out = float(np.max(expected / V_S) ** 2)
    assert left_out < 0.03
    assert rate == pytest.approx(np.array([expected, expected]), rel=left_out)


@pytest.fixture(scope="module")
def hard():
    """A block beyond x^2 = 3/2, its c = -F', and its onset."""
    speed = 1.8 * V_S
    assert third_derivative(speed) < 0
    slider, c = block(speed)
    return slider, c, find_onset(slider, "c_x", list(c * np.array([0.9, 1.2, 2.2])))


def test_a_hard_onset_has_hysteresis(hard):
    """Steady sliding and stick-slip are both there above c."""
    _, c, found = hard
    assert found.kind == "hard"
    assert repr(found).startswith("<Onset along c_x: hard, hysteresis from 10.5")
    assert len(repr(found)) < 100
    (low, high), errors = found.hysteresis, found.hysteresis_uncertainty
    assert abs(low - c) <= errors[0] < 0.01 * c  # it cannot rest below c
    assert errors[1] < 0.02 * c
    shares = found.data["value"].values / c
    up, down = found.data["outcome"].values
    assert (up[shares < high / c - 0.02] != 0).all()
    assert (down[shares < 0.95] == 1).all()
    assert (down[shares > 1.05] == 0).all()
    assert up[-1] == 0  # so much damping leaves no oscillation


@pytest.mark.parametrize(("off", "lasts"), [(-3.0, True), (3.0, False)])
def test_the_far_end_of_hysteresis_is_that_of_direct_simulation(hard, off, lasts):
    """From the oscillation of a weaker damping it lasts below that end, and dies out above it."""
    slider, c, found = hard
    damping = found.hysteresis[1] + off * found.hysteresis_uncertainty[1]
    state = None
    for value in np.linspace(c, damping, 8):
        run = st.simulate(slider.replace(c_x=value), 20.0, initial=state, sample_rate=200.0)
        state = run.state(20.0)
    last = run.data["u_x"].values[-400:]
    assert (np.ptp(last) > 0.1 * np.ptp(found.data["amplitude"].values)) == lasts


def test_without_weakening_there_is_no_onset():
    slider = PAPER.replace(friction=st.Coulomb(mu_0=0.2))
    found = find_onset(slider, "phi", ["5 deg", "10 deg", "20 deg"])
    assert found.kind == "none"
    assert np.isnan([found.threshold, *found.hysteresis]).all()
    assert not found.data["outcome"].values.any()


def test_values_must_ascend():
    with pytest.raises(st.DescriptionError, match="three or more that ascend"):
        find_onset(PAPER, "phi", ["9 deg", "8 deg", "7 deg"])
    with pytest.raises(st.DescriptionError, match="between -90 deg and 90 deg"):
        find_onset(PAPER, "phi", ["9 deg", "80 deg", "100 deg"])
