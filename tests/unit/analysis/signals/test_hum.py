"""Lines and peaks of a spectrum."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from stiction.analysis.signals.even_grid import even_grid
from stiction.analysis.signals.hum import beat_frequency, narrow_lines, peak_frequencies


@pytest.mark.parametrize("frequency", [2.0, 40.0, 49.9])  # the last at the end of the spectrum
def test_the_clearest_peak_is_that_of_a_sine(frequency: float) -> None:
    time = np.arange(0.0, 100.0, 0.01)
    noise = 0.01 * np.random.default_rng(1).normal(size=len(time))
    found = peak_frequencies(even_grid(time), np.sin(2 * pi * frequency * time + 1.0) + noise)
    assert found[0] == pytest.approx(frequency, abs=0.02)


@pytest.mark.parametrize("width", [0.05, 0.2])  # Hz
def test_noise_in_a_band_does_not_beat(width: float) -> None:
    random, time = np.random.default_rng(3), np.arange(0.0, 400.0, 0.04)
    at = 1.0 + width * random.uniform(-0.5, 0.5, 200)
    force = np.cos(2 * pi * at[:, None] * time + random.uniform(0, 6, (200, 1))).sum(axis=0)
    assert beat_frequency(time, force) is None


@pytest.mark.parametrize(("beside", "clearness"), [(0.25, 16.0 / 9.0), (0.5, 4.0 / 9.0)])
def test_a_line_is_clear_if_nine_times_as_strong_as_another_within_half_an_octave(
    beside: float, clearness: float
) -> None:
    time = 1e-3 * np.arange(20000)
    noise = 1e-3 * np.random.default_rng(1).normal(size=len(time))
    force = np.sin(60.0 * pi * time) + beside * np.sin(74.0 * pi * time) + noise
    first = narrow_lines(even_grid(time), force, 0.3)[0]
    assert first.frequency == pytest.approx(30.0, rel=1e-3)
    assert first.clearness == pytest.approx(clearness, rel=0.01)
    assert len(narrow_lines(even_grid(time), force)) == (clearness > 1.0)
