"""Medians and means of values among which a few are wild."""

import numpy as np
import pytest

from stiction.analysis.signals.robust import median


@pytest.mark.parametrize("count", [1, 2, 3, 4, 63, 64, 1001])
def test_the_median_is_that_of_numpy_to_the_last_bit(count):
    random = np.random.default_rng(count)
    for values in (random.standard_normal(count), random.integers(-9, 9, count)):
        before = values.copy()
        assert median(values) == np.median(values)
        assert values.tolist() == before.tolist()
    holed = random.standard_normal(count)
    holed[random.integers(count)] = np.nan
    assert np.isnan(median(holed))
