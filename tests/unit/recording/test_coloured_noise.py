"""Noise that lasts, told from rows of samples of the same course."""

import numpy as np
import pytest

from stiction.recording.coloured_noise import coloured_noise, draw_lasting

SIZE, COUNT = 70, 20
COURSE = np.log(np.linspace(1.0, 3.0, SIZE))


def rows(seed: int, white: float = 1.0, lasting: float = 0.0, time: float = 5.0) -> np.ndarray:
    """Return rows whose course and level differ a little, with noise."""
    random = np.random.default_rng(seed)
    scale = 1.0 + 0.05 * random.standard_normal((COUNT, 2))
    found = 100.0 * (scale[:, :1] * COURSE + scale[:, 1:])
    found += white * random.standard_normal((COUNT, SIZE))
    return found + [draw_lasting(SIZE, lasting, time, random) for _ in range(COUNT)]


def test_white_noise_is_white():
    assert all(coloured_noise(rows(seed)) is None for seed in range(40))


@pytest.mark.parametrize("time", [1.5, 4.0, 10.0])
@pytest.mark.parametrize("lasting", [1.0, 3.0])
def test_noise_that_lasts_is_measured(lasting, time):
    found = [coloured_noise(rows(seed, 1.0, lasting, time)) for seed in range(8)]
    white, deviation, times = np.median(found, axis=0)
    assert 0.6 < times / time < 1.7  # those tried are a factor of 1.4 apart
    assert 0.8 < deviation / lasting < 1.25
    assert white < 1.2


def test_what_all_rows_have_in_common_is_no_noise():
    swing = 20.0 * np.sin(np.linspace(0.0, 30.0, SIZE))
    assert coloured_noise(rows(1) + swing) is None


def test_a_swing_that_dies_out_is_no_noise():
    swings = 20.0 * np.exp(-np.linspace(0.0, 8.0, SIZE)) * np.sin(np.linspace(0.0, 30.0, SIZE))
    phases = np.random.default_rng(1).standard_normal((COUNT, 1))
    assert coloured_noise(rows(1) + phases * swings) is None


def test_a_few_rows_of_another_course_do_not_matter():
    odd = np.zeros((COUNT, SIZE))
    odd[[3, 11]] = 30.0 * np.sin(np.linspace(0.0, 25.0, SIZE))
    assert coloured_noise(rows(2) + odd) is None
    found, own = coloured_noise(rows(2, 1.0, 2.0) + odd), coloured_noise(rows(2, 1.0, 2.0))
    assert np.allclose(found, own, rtol=0.5)


def test_few_or_equal_rows_tell_nothing():
    assert coloured_noise(rows(1, 1.0, 3.0)[:4]) is None
    assert coloured_noise(rows(1, 1.0, 3.0)[:, :20]) is None
    assert coloured_noise(np.tile(COURSE, (COUNT, 1))) is None


def test_drawn_noise_has_its_deviation_and_correlation():
    values = draw_lasting(200_000, 0.5, 8.0, np.random.default_rng(3))
    assert np.std(values) == pytest.approx(0.5, rel=0.03)
    correlation = np.corrcoef(values[:-8], values[8:])[0, 1]
    assert correlation == pytest.approx(np.exp(-1.0), abs=0.03)
    first = [draw_lasting(2, 0.5, 8.0, np.random.default_rng(seed))[0] for seed in range(2000)]
    assert np.std(first) == pytest.approx(0.5, rel=0.06)  # it has lasted before
