"""Straight lines, and their errors where neighbours deviate alike."""

import numpy as np
import pytest
from scipy.signal import lfilter

from stiction.analysis.signals.correlated_noise import correlation_time, whole_correlation_time
from stiction.analysis.signals.straight_line import line


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
    values = np.random.default_rng(7).standard_normal(400)
    x = np.linspace(-1.0, 1.0, 4000)
    y = np.repeat(values, 10)
    found = line(x, y)
    assert correlation_time(found.deviations(x, y)) == pytest.approx(10.0, rel=0.1)
    alike = whole_correlation_time(found.deviations(x, y))
    assert found.correlated_error(x, y) == pytest.approx(found.slope_error * alike**0.5)


@pytest.mark.parametrize("count", [12, 50])
def test_the_errors_of_a_few_alike_neighbours_hold_the_slope(count):
    """A line follows a part of what lasts, so that its deviations seem to last for less."""
    noise = np.random.default_rng(count).standard_normal((1000, 100 + count))
    values = lfilter([1.0], [1.0, -0.7], noise)[:, 100:]
    x = np.arange(float(count))
    lines = [(line(x, y), y) for y in values]
    off = np.array([abs(found.slope) / found.correlated_error(x, y) for found, y in lines])
    assert np.mean(off < 2.0) > 0.88  # 0.75 and 0.86 by `correlation_time`
    assert np.mean(off > 4.0) < 0.02
