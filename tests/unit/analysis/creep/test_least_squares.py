"""Fits to creep curves: which bins count, and what is fitted, with its errors."""

import numpy as np
import pytest
import xarray as xr
from scipy import optimize

from stiction.analysis.creep.curve import CURVES
from stiction.analysis.creep.least_squares import (
    FEWEST_USED,
    STEP,
    THEORY,
    best_fit,
    forward_differences,
    used_bins,
)
from stiction.errors import ResultError

ENDS = np.arange(10.0)  # s to slip; each bin begins 1 s before its end
VELOCITY, ERROR = np.linspace(1.0, -8.0, 10), np.full(10, 0.02)


def curve(velocity=VELOCITY, error=ERROR):
    columns = velocity, error, np.ones(10), ENDS + 1.0, ENDS
    return xr.Dataset({name: ("bin", each) for name, each in zip(CURVES, columns, strict=True)})


def test_bins_count_that_lie_in_a_stretch_and_are_known():
    unknown = np.where(ENDS == 5.0, np.nan, VELOCITY)
    used = used_bins(curve(unknown), 1.5, 8.5)
    assert used.end.tolist() == [2.0, 3.0, 4.0, 6.0, 7.0]
    assert used_bins(curve(), 2.0, 8.0).end.tolist() == [2.0, 3.0, 4.0, 5.0, 6.0, 7.0]


def test_errors_of_bins_include_that_of_the_theory():
    lost = np.where(ENDS == 3.0, np.nan, ERROR)
    used = used_bins(curve(error=lost), 0.0, 20.0)
    own = np.where(ENDS == 3.0, 0.0, 0.02)
    assert used.error == pytest.approx(np.hypot(own, THEORY * np.abs(VELOCITY)))


@pytest.mark.parametrize(
    ("low", "high", "remedy"),
    [
        (0.5, 5.5, "between 500 ms and 5.5 s before slip .* 4 of the 5 bins .* narrower bins"),
        (5.5, 10.5, "4 of the 5 bins .* the longest stick phase takes 10 s only"),
    ],
)
def test_too_few_bins_are_refused_with_the_remedy(low, high, remedy):
    with pytest.raises(ResultError, match=remedy):
        used_bins(curve(), low, high)
    assert len(used_bins(curve(), 0.5, 6.0).end) == FEWEST_USED


X = np.linspace(0.0, 1.0, 30)
NOISE = np.random.default_rng(4).standard_normal(30)
FAR = (-1e9, -1e9), (1e9, 1e9)


def line(level, slope):
    return level + slope * X


@pytest.mark.parametrize("unit", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("times", [0.5, 3.0])
def test_a_line_has_the_parameters_and_errors_of_the_normal_equations(unit, times):
    """Errors that are too small for the scatter are scaled up, those too large are not down."""
    errors = unit * np.linspace(0.1, 0.3, 30)
    values = unit * line(2.0, -3.0) + times * errors * NOISE
    far = tuple(tuple(unit * each for each in end) for end in FAR)
    found = best_fit(line, values, errors, [(unit, unit)], far, (unit, unit))
    rows = np.stack([1.0 / errors, X / errors], axis=1)
    expected, square, *_ = np.linalg.lstsq(rows, values / errors)
    excess = max(1.0, square[0] / 28)
    assert (excess > 1.0) == (times == 3.0)
    assert found.values == pytest.approx(expected, rel=1e-6)
    assert found.chi_square == pytest.approx(square[0], rel=1e-6)
    assert found.excess == pytest.approx(excess, rel=1e-6)
    covariance = excess * np.linalg.inv(rows.T @ rows)
    assert found.covariance == pytest.approx(covariance, rel=1e-5)
    assert found.errors == pytest.approx(np.diag(covariance) ** 0.5, rel=1e-5)


@pytest.mark.parametrize("starts", [[(0.4,), (2.9,)], [(2.9,), (0.4,)]])
def test_the_best_of_several_starts_counts(starts):
    """A slow wave through samples of it, and another minimum."""

    def wave(pitch):
        return np.sin(2.0 * np.pi * pitch * X)

    found = best_fit(wave, wave(0.5), np.full(30, 0.1), starts, ((0.0,), (5.0,)), (1.0,))
    assert found.values == pytest.approx((0.5,), abs=1e-6)
    other = best_fit(wave, wave(0.5), np.full(30, 0.1), [(2.9,)], ((0.0,), (5.0,)), (1.0,))
    assert other.chi_square > 100.0


def test_parameters_stay_within_their_bounds():
    bounds = (0.0, -1.0), (1.5, 1e9)
    found = best_fit(line, line(2.0, -3.0), np.full(30, 0.1), [(1.0, 0.0)], bounds, (2.0, 5.0))
    assert found.values == pytest.approx((1.0, -1.0), abs=1e-6)


def test_a_fit_that_does_not_converge_is_refused(monkeypatch):
    def give_up(*_, **options):
        raise RuntimeError(f"no end after {options['max_nfev']}")

    monkeypatch.setattr(optimize, "curve_fit", give_up)
    with pytest.raises(ResultError, match="does not have the shape that is fitted"):
        best_fit(line, line(2.0, -3.0), np.ones(30), [(1.0, 0.0)], FAR, (1.0, 1.0))


@pytest.mark.parametrize("highest", [(np.inf, np.inf), (3.0, -2.0)])
@pytest.mark.parametrize("far", [1.0, 1e6])
def test_derivatives_are_those_of_the_model_up_to_the_highest_parameters(highest, far):
    """A parabola is off by the step times half of its curvature, and by rounding over the step."""

    def parabola(at):
        assert np.all(at <= highest)
        return at[0] * X**2 + at[1] ** 2 / far

    found = forward_differences(parabola, np.array([3.0, -2.0]), np.array(highest))
    expected = np.stack([X**2, np.full(30, -4.0 / far)], axis=1)
    assert found == pytest.approx(expected, rel=0.0, abs=4.0 * STEP)
