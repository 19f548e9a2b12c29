"""Medians and means of values among which a few are wild."""

import numpy as np
import pytest
from scipy.ndimage import median_filter

from stiction.analysis.signals.robust import median_of_three


@pytest.mark.parametrize("size", [3, 4, 50])
def test_the_median_of_three_in_a_row_is_that_of_a_filter(size):
    values = np.random.default_rng(size).integers(-3, 3, size)  # with ties
    found = median_of_three(values[:-2], values[1:-1], values[2:])
    assert found.dtype == values.dtype
    assert found.tolist() == median_filter(values, 3, mode="nearest")[1:-1].tolist()
