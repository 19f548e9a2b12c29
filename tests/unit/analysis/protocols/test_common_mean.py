"""The mean of values with errors: its error holds, and chance is told from a difference."""

import numpy as np
import pytest
from scipy.stats import t as student

from stiction.analysis.protocols.common_mean import common_mean

ERRORS = np.array([1.0, 2.0, 0.5, 3.0, 1.5])
SHARES = np.array([0.5, -1.0, 2.0, 1.0, -0.5])
TRIALS = 4000


def draws(between=0.0, shares=SHARES):
    """Yield values about 7 with their own errors, and those of a quantity that they share."""
    random = np.random.default_rng(1)
    for _ in range(TRIALS):
        own = np.hypot(ERRORS, between) * random.standard_normal(len(ERRORS))
        yield 7.0 + own + shares * random.standard_normal()


def test_the_error_of_a_mean_is_how_far_it_is_off():
    """A quantity that all share is sought with it: it neither averages away nor counts twice."""
    found = [common_mean(values, ERRORS, SHARES) for values in draws()]
    off = np.array([each.value - 7.0 for each in found]) / found[0].error
    assert off.std() == pytest.approx(1.0, abs=4.0 / (2.0 * TRIALS) ** 0.5)
    assert abs(off.mean()) < 4.0 / TRIALS**0.5
    assert np.mean([each.square for each in found]) == pytest.approx(found[0].free, rel=0.1)
    assert sum(not each.alike for each in found) < 0.003 * TRIALS


def test_values_that_vary_have_the_error_of_their_scatter():
    found = [common_mean(values, ERRORS, SHARES) for values in draws(20.0)]
    assert np.mean([each.alike for each in found]) < 0.1
    off = np.array([(each.value - 7.0) / each.scaled_error for each in found if not each.alike])
    assert 0.5 < off.std() < 2.0
    alone = [common_mean(values, ERRORS) for values in draws(20.0, 0.0)]
    between = np.mean([each.variance_between for each in alone])
    assert between == pytest.approx(20.0**2, rel=0.1)


def test_where_errors_are_stated_half_as_large_the_safe_error_holds_as_a_small_sample_can():
    """Beyond three such errors lie no more than by Student's law of as many free values."""
    found = [common_mean(values, 0.5 * ERRORS) for values in draws(shares=0.0)]
    off = np.array([each.value - 7.0 for each in found])
    safe, gated = (
        np.abs(off) > 3.0 * np.array([getattr(each, name) for each in found])
        for name in ("safe_error", "scaled_error")
    )
    expected = 2.0 * student.sf(3.0, found[0].free)
    assert safe.mean() < expected + 4.0 * (expected / TRIALS) ** 0.5
    assert gated.mean() > 2.0 * expected  # by which a rig as stated was called stiffer


@pytest.mark.parametrize("values", [[7.0, 7.0], [7.0, 7.5], [7.0]])
def test_values_that_agree_have_no_smaller_error_than_theirs(values):
    found = common_mean(np.array(values), np.ones(len(values)))
    assert found.safe_error == found.error == pytest.approx(len(values) ** -0.5)


def test_a_value_without_error_has_the_weight():
    found = common_mean(np.array([1.0, 2.0, 3.0]), np.array([0.1, 0.0, 0.1]))
    assert found.value == pytest.approx(2.0, abs=1e-9)
    assert common_mean(np.array([1.0, 2.0]), np.zeros(2)).value == pytest.approx(1.5)


def test_an_error_that_counts_in_two_values_is_averaged_away_by_half_as_many():
    once, twice = (common_mean(ERRORS, ERRORS, times=times) for times in (1, 2))
    assert twice.error == pytest.approx(2.0**0.5 * once.error)
    assert twice.value == pytest.approx(once.value)
