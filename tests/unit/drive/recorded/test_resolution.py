"""The test of noise: false alarms and misses on many random signals, and whether its advice helps.

The rates in `docs/method.md` (M80) are those of these signals.
"""

import numpy as np
import pytest
from scipy import signal
from scipy.interpolate import CubicSpline

from stiction.drive.recorded.resolution import (
    NOTICED,
    SLOPE_NOISE,
    correlation,
    deviations,
    roughness,
)


def smooth_signal(rng, count, rows):
    """Harmonics with at least so many rows to a period, evenly spaced or not; largest value 1."""
    jitter = rng.choice([0.0, 0.3])
    t = np.arange(count) + jitter * rng.uniform(-0.5, 0.5, count)
    y = np.full(count, rng.normal())
    for _ in range(rng.integers(1, 8)):
        period = rows * np.exp(rng.uniform(0.0, np.log(max(1.01, count / rows))))
        y += rng.lognormal() * np.sin(2 * np.pi * t / period + rng.uniform(0.0, 7.0))
    return 1e-3 * t, y / np.abs(y).max()


def lengths(rng, low, high, times):
    return np.exp(rng.uniform(np.log(low), np.log(high), times)).astype(int)


@pytest.mark.parametrize("digits", [None, 4], ids=["exact", "rounded"])
def test_no_smooth_signal_is_taken_for_noise(digits):
    """With five rows to the fastest period: none of 500, rounded to four digits or not."""
    rng = np.random.default_rng(1)
    for count in lengths(rng, 10, 2000, 500):
        t, y = smooth_signal(rng, count, rows=5.0)
        y = y if digits is None else np.round(y, digits)
        assert roughness(t, y, 1.0, False) is None


@pytest.mark.parametrize("seed", range(5))
def test_no_smooth_position_is_taken_for_noise(seed):
    rng = np.random.default_rng(seed)
    for count in lengths(rng, 10, 2000, 50):
        t, v = smooth_signal(rng, count, rows=5.0)
        x = CubicSpline(t, v).antiderivative()(t)
        assert roughness(t, x, 1.0, True) is None


@pytest.mark.parametrize(("share", "least"), [(0.005, 0.98), (0.02, 1.0), (0.3, 1.0)])
def test_noise_is_found(share, least):
    """White noise of 0.5 % or more, in 30 rows or more."""
    rng = np.random.default_rng(2)
    found = []
    for count in lengths(rng, 30, 2000, 300):
        t, y = smooth_signal(rng, count, rows=12.0)
        y = y + share * rng.normal(size=count)
        found.append(roughness(t, y, np.abs(y).max(), False))
    assert np.mean([each is not None for each in found]) >= least
    told = [each.noise for each in found if each is not None]
    assert np.median(told) == pytest.approx(share, rel=0.1)


def test_noise_without_effect_is_not_told():
    """Such as rounded digits: less than a thousandth of the largest value."""
    rng = np.random.default_rng(3)
    for count in lengths(rng, 30, 2000, 100):
        t, y = smooth_signal(rng, count, rows=12.0)
        assert roughness(t, y + 0.5 * NOTICED * rng.normal(size=count), 1.0, False) is None


def test_white_noise_keeps_its_deviation_and_correlates_as_fourth_differences_do():
    """Variance as it is, on any rows; neighbours -4/5 on even ones: C(8, 5)/C(8, 4)."""
    rng = np.random.default_rng(4)
    y = rng.normal(size=200_000)
    even, uneven = np.arange(200_000.0), np.cumsum(rng.uniform(0.3, 1.0, 200_000))
    assert np.std(deviations(even, y)) == pytest.approx(1.0, rel=0.02)
    assert np.std(deviations(uneven, y)) == pytest.approx(1.0, rel=0.02)
    assert correlation(deviations(even, y)) == pytest.approx(-0.8, abs=0.01)
    fourth = np.diff(y, 4)
    assert deviations(even, y) == pytest.approx(fourth / np.sqrt(70.0), rel=1e-6, abs=1e-9)


def test_a_harmonic_correlates_as_its_rows_to_a_period():
    t = np.arange(5000.0)
    for rows in (3.0, 4.0, 8.0, 20.0):
        off = deviations(t, np.sin(2 * np.pi * t / rows + 0.3))
        assert correlation(off) == pytest.approx(np.cos(2 * np.pi / rows), abs=2e-3)


def test_a_cubic_does_not_deviate():
    t = np.cumsum(np.random.default_rng(5).uniform(0.2, 1.0, 50))
    y = 3.0 - t + 0.2 * t**2 - 0.01 * t**3
    assert deviations(t, y) == pytest.approx(0.0, abs=1e-10 * np.abs(y).max())


def test_the_slope_of_a_spline_through_noise():
    rng = np.random.default_rng(6)
    slopes = CubicSpline(np.arange(100_000.0), rng.normal(size=100_000))(np.arange(1e5), 1)
    assert np.std(slopes) == pytest.approx(SLOPE_NOISE, rel=0.02)


def test_single_jumps_are_told_from_noise():
    t = np.linspace(0.0, 1.0, 401)
    y = 1.0 + 0.2 * np.sin(9.0 * t) + 0.5 * (t > 0.3) - 0.3 * (t > 0.7)
    found = roughness(t, y, np.abs(y).max(), False)
    assert found is not None
    assert found.jumps == pytest.approx([0.3 * 400, 0.7 * 400], abs=1)


@pytest.mark.parametrize("share", [0.003, 0.01, 0.05])
def test_the_advice_helps(share):
    """The filter that is named makes the record one that is taken, and nearer to the truth."""
    rng = np.random.default_rng(7)
    better = []
    for count in lengths(rng, 300, 5000, 40):
        t = 1e-3 * np.arange(count)
        tones = [np.exp(rng.uniform(0.0, np.log(40.0))) for _ in range(4)]
        y = sum(rng.lognormal() * np.sin(2 * np.pi * f * t + rng.uniform(0, 7)) for f in tones)
        y = y / np.abs(y).max()
        rough = y + share * rng.normal(size=count)
        found = roughness(t, rough, 1.0, False)
        assert found is not None
        sos = signal.butter(4, found.cut_off, fs=found.rate, output="sos")
        filtered = signal.sosfiltfilt(sos, rough)
        assert roughness(t, filtered, 1.0, False) is None
        better.append(np.std(filtered - y) / np.std(rough - y))
    assert np.median(better) < 0.6
