"""The benchmark's own arithmetic: orders, drifts, quadratures, intervals. Nothing is timed."""

from math import comb, inf, pi

import numpy as np
import pytest
from benchmarks.accuracy.conservation import drift
from benchmarks.accuracy.convergence import order
from benchmarks.accuracy.energy import balance, quadrature
from benchmarks.cases.case import growth
from benchmarks.regression.verdict import left_out, ratio, slower

import stiction as st


def test_the_order_of_a_power_is_its_exponent():
    x = np.geomspace(1e-3, 1e-9, 7)
    exponent, error = order(x, 42.0 * x**0.8)
    assert exponent == pytest.approx(0.8, rel=1e-12)
    assert error < 1e-10
    scattered, error = order(x, x * [1.3, 1.0, 1.3, 1.0, 1.3, 1.0, 1.3])
    assert abs(scattered - 1.0) < 2 * error
    with pytest.raises(ValueError, match="three points"):
        order(x[:2], x[:2])


def test_drift_is_a_slope_with_its_error():
    n = np.arange(100)
    wiggle = 0.1 * (-1.0) ** n
    slope, error = drift(5.0 + 0.03 * n + wiggle)
    assert abs(slope - 0.03) < 3 * error
    assert error < 1e-3


def test_growth_of_a_swelling_wave():
    t = np.arange(40) / 50.0
    values = np.exp(0.7 * t) * np.cos(9.0 * t) + 0.1 * np.exp(-3.0 * t)
    assert growth(values, 50.0, 3) == pytest.approx(0.7, rel=1e-6)


def test_quadrature_breaks_at_sticks():
    """Exact for what is linear while stuck, and for a root of time at the ends of a slip."""
    sticks = np.array([[1.0, 1.5], [2.0, 2.2]])
    t, weights, marks = quadrature(sticks, 3.0, 0.5, 12)
    assert np.all(np.diff(t) >= 0.0)
    assert t[marks].tolist() == [1.0, 2.0, 3.0]
    assert weights.sum() == pytest.approx(3.0, rel=1e-14)
    stuck = ((t > 1.0) & (t < 1.5)) | ((t > 2.0) & (t < 2.2))
    values = np.where(stuck, 2.0 * t, 0.0)
    assert values @ weights == pytest.approx(1.5**2 - 1.0 + 2.2**2 - 4.0, rel=1e-14)
    slip = (t > 1.5) & (t < 2.0)
    root = np.where(slip, np.sqrt(np.clip(t - 1.5, 0.0, None)), 0.0)
    assert root @ weights == pytest.approx(2 / 3 * 0.5**1.5, rel=1e-6)


def test_energy_is_balanced():
    """To the tolerance, so closely that a ten-millionth of the friction would be missed."""
    slider = st.presets.nakano_popov_2020().replace(c_x=1.0, c_y=20.0)
    found = balance(slider, 0.1, 1e-9)
    assert abs(found.residual[-1]) < 1e-8 * found.work[-1]
    assert abs(found.residual[-1]) < 1e-7 * found.friction[-1]
    assert found.damper[-1] > 0.0
    period = 2 * pi * np.sqrt(slider.mass / slider.k_y)
    assert len(found.t) > 0.5 * 0.1 / period  # a stick in most transverse periods


@pytest.mark.parametrize("n", [6, 9, 20, 50])
def test_the_interval_of_the_sign_test_holds_what_it_says(n):
    k = left_out(n, 0.95)
    outside = 2 * sum(comb(n, i) for i in range(k + 1)) / 2**n
    assert outside <= 0.05
    assert outside + 2 * comb(n, k + 1) / 2**n > 0.05  # and no more than it must


def test_few_ratios_decide_nothing():
    assert left_out(5, 0.95) is None
    few = ratio([1.5] * 5)
    assert few == (1.5, 0.0, inf)
    assert slower(few, 1.1) is None


def test_a_regression_is_told_from_noise():
    noise = np.linspace(-0.05, 0.05, 12)
    assert slower(ratio(list(1.2 + noise)), 1.1) is True
    assert slower(ratio(list(1.0 + noise)), 1.1) is False
    assert slower(ratio(list(1.1 + noise)), 1.1) is None
    found = ratio([1.0, 1.0, 9.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0])  # one outlier moves nothing
    assert found == (1.0, 1.0, 1.0)
