"""Straight lines, and their errors where neighbours deviate alike."""

import numpy as np
import pytest
from scipy.signal import lfilter

from stiction.analysis.signals.correlated_noise import error_of_few
from stiction.analysis.signals.straight_line import LASTING, line, slope_in_lasting_noise


def test_numbers_and_errors_are_those_of_the_normal_equations():
    x = np.linspace(3.0, 5.0, 40)
    y = 2.0 - 0.7 * x + 0.01 * np.cos(40.0 * x)
    found = line(x, y)
    (slope, offset), covariance = np.polyfit(x, y, 1, cov=True)
    assert (found.slope, found.offset) == pytest.approx((slope, offset), rel=1e-12)
    assert found[3:] == pytest.approx(np.sqrt(np.diag(covariance)), rel=1e-10)


def test_a_line_over_times_since_1970_is_that_over_times_from_0():
    x = np.arange(0.0, 100.0, 1.0 / 1024.0)  # of which sums with 2^30 have no rounding
    y = 3.0 + 0.2 * x + np.random.default_rng(1).standard_normal(len(x))
    near, far = line(x, y), line(x + 2.0**30, y)
    assert (far.slope, far.slope_error) == pytest.approx((near.slope, near.slope_error), rel=1e-12)
    assert far.deviations(x + 2.0**30, y) == pytest.approx(near.deviations(x, y), abs=1e-12)
    assert far.at(2.0**30) == pytest.approx(near.offset, abs=1e-12)


def test_alike_neighbours_make_the_error_larger():
    """Each value stands ten times in a row: as many values tell the line as are different."""
    values = np.random.default_rng(7).standard_normal(100)
    x = np.linspace(-1.0, 1.0, 1000)
    slope, error = slope_in_lasting_noise(x, np.repeat(values, 10))
    alone, its = slope_in_lasting_noise(np.linspace(-1.0, 1.0, 100), values)
    assert slope == pytest.approx(alone, abs=0.5 * its)
    assert its < error < 1.6 * its  # neighbours seem to have a correlation of 0.9: 19 count as one


def test_independent_neighbours_have_the_error_of_the_line():
    x, noise = np.arange(400.0), np.random.default_rng(3).standard_normal(400)
    found, (slope, error) = (
        line(x, 2.0 + 0.5 * x + noise),
        slope_in_lasting_noise(x, 0.5 * x + noise),
    )
    assert slope == pytest.approx(found.slope, abs=0.2 * error)
    assert error == pytest.approx(found.slope_error, rel=0.1)


def test_points_on_a_line_leave_no_error():
    x = np.arange(5.0)
    assert slope_in_lasting_noise(x, 2.0 * x + 1.0) == pytest.approx((2.0, 0.0), abs=1e-12)
    assert slope_in_lasting_noise(x, 0.0 * x) == pytest.approx((0.0, 0.0), abs=1e-12)


@pytest.mark.parametrize("alike", [0.0, 0.5, 0.7, 0.9])
@pytest.mark.parametrize("count", [4, 8, 12, 50])
def test_the_errors_of_a_few_alike_neighbours_hold_the_slope(count, alike):
    """A line follows a part of what lasts, so that its deviations seem to last for less."""
    noise = np.random.default_rng(count).standard_normal((400, 200 + count))
    values = lfilter([1.0], [1.0, -alike], noise)[:, 200:]
    x = np.arange(float(count))
    found = np.array([slope_in_lasting_noise(x, y) for y in values])
    off = np.abs(found[:, 0]) / found[:, 1]
    assert np.mean(off < 2.0) > 0.93  # by the correlation of the deviations 0.77 at worst
    assert np.mean(off > 4.0) < 0.02


@pytest.mark.parametrize("count", [4, 9])
def test_a_slope_is_a_mean_by_the_restricted_likelihood_of_each_correlation(count):
    """With covariances written out, of noise whose innovations have one variance."""
    x, y = np.arange(float(count)), np.random.default_rng(count).standard_normal(count)
    design, apart = np.stack([np.ones(count), x], axis=1), np.abs(x[:, None] - x)
    slopes, variances, likely = [], [], []
    for alike in LASTING:
        covariance = alike**apart / (1.0 - alike**2)
        weights = np.linalg.inv(covariance)
        normal = design.T @ weights @ design
        found = np.linalg.solve(normal, design.T @ weights @ y)
        away = y - design @ found
        left = away @ weights @ away
        slopes.append(found[1])
        variances.append(left / (count - 2.0) * np.linalg.inv(normal)[1, 1])
        dets = np.linalg.slogdet(covariance)[1] + np.linalg.slogdet(normal)[1]
        likely.append(-0.5 * (dets + (count - 2.0) * np.log(left)))
    weight = np.exp(np.array(likely) - max(likely))
    slope = np.average(slopes, weights=weight)
    variance = np.average(variances + (np.array(slopes) - slope) ** 2, weights=weight)
    expected = slope, error_of_few(variance**0.5, count - 2.0)
    assert slope_in_lasting_noise(x, y) == pytest.approx(expected, rel=1e-9)
