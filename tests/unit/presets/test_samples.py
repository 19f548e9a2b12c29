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
