"""Extremes and crossings from evenly spaced samples."""

import numpy as np
import pytest

from stiction.presets.samples import crest, upward_crossings


def test_a_crest_is_that_of_the_curve():
    t = np.linspace(0.0, 3.0, 301)
    assert crest(np.sin(t)) == pytest.approx(1.0, abs=0.01**4)
    assert crest(t) == 3.0


def test_crossings_are_those_of_the_curve():
    t = np.linspace(0.0, 20.0, 401)
    found = upward_crossings(t, np.sin(t - 0.3))
    assert found == pytest.approx(0.3 + 2 * np.pi * np.arange(4), abs=0.05**4)


def test_crossings_at_a_sample_are_found():
    """Rounding may put the root of a curve that is zero at a sample beside the interval."""
    for k in range(400):
        shift = 0.05 * (k % 20 + 3) * (1.0 + 1e-16 * (k - 200))
        t = np.linspace(0.0, 20.0, 401) + 1e-3 * k
        found = upward_crossings(t, np.sin(t - t[0] - shift))
        assert found[:3] == pytest.approx(t[0] + shift + 2 * np.pi * np.arange(3), abs=0.05**4)
