"""Intervals of drawn values."""

import numpy as np
import pytest

from stiction.analysis.signals.correlated_noise import interval_95


@pytest.mark.parametrize("count", [64, 200])
def test_the_ends_of_an_interval_lie_as_often_too_far_in_as_too_far_out(count):
    """Of a uniform distribution, whose shares are its values; and so of any other."""
    low, high = interval_95(np.random.default_rng(count).random((count, 10_000)))
    assert low.shape == high.shape == (10_000,)
    assert np.median(low) == pytest.approx(0.025, abs=1e-3)
    assert np.median(high) == pytest.approx(0.975, abs=1e-3)
