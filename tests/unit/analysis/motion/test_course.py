"""The course of a force without cycles."""

import numpy as np

from stiction.analysis.motion.course import dies_out


def test_a_vibration_that_dies_down_over_hundreds_of_swings_settles():
    """The fast beat at first grew: 600 swings in order were "irregular vibration"."""
    number = np.arange(700)
    size = np.where(number < 100, 1.0 + 1e-3 * number, np.exp(-(number - 100) / 220.0))
    assert dies_out(size, np.ones(700), 0.5)
    assert not dies_out(size[::-1], np.ones(700), 0.5)
    assert not dies_out(np.tile(size[:100], 7), np.ones(700), 0.5)
