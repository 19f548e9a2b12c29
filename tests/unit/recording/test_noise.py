"""Estimates of noise and quantisation from samples."""

import numpy as np
import pytest

from stiction.recording.noise import (
    dither_remainder,
    lattice,
    noise_level,
    resolved_noise,
    white_noise,
)


def sawtooth(count=20000, drop=0.05, every=997):
    """A force that rises evenly and drops at once."""
    return drop * (np.arange(count) % every) / every


@pytest.mark.parametrize("noise", [1e-4, 1e-3, 1e-2])
def test_noise_is_estimated_without_bias(noise):
    """Against the known noise of 200 records; the mean of their estimates has 0.3 % of error."""
    found = []
    for seed in range(200):
        random = np.random.default_rng(seed)
        found.append(noise_level(sawtooth(5000) + noise * random.standard_normal(5000)).noise)
    spread = np.std(found) / noise
    assert spread < 0.04
    # the median of |x| of a sample shared by few slips: 5 of 5000 differences are off
    assert abs(np.mean(found) / noise - 1.0) < 3.0 * spread / 200**0.5 + 0.005


@pytest.mark.parametrize("ratio", [0.5, 1.0, 3.0])
def test_noise_beside_quantisation(ratio):
    """The variance of rounding is subtracted; half a step of noise is resolved to 3 %."""
    step, found = 2e-3, []
    for seed in range(60):
        random = np.random.default_rng(seed)
        values = sawtooth() + ratio * step * random.standard_normal(20000)
        level = noise_level(step * np.rint(values / step))
        assert level.quantisation == pytest.approx(step, rel=1e-9)
        found.append(level.noise)
    assert np.mean(found) == pytest.approx(ratio * step, rel=0.03)


def test_noise_that_is_less_than_the_steps_is_not_invented():
    values = 2e-3 * np.rint(sawtooth() / 2e-3)
    level = noise_level(values)
    assert level.noise == 0.0
    assert resolved_noise(np.arange(200.0), 0.0) == 0.0
    assert level.quantisation == pytest.approx(2e-3, rel=1e-12)


@pytest.mark.parametrize("noise", [0.0, 0.1, 0.2, 0.4, 0.8])
def test_the_rounding_of_a_ramp_is_not_noise(noise):
    """It is not white: fourth differences took that of half a step a sample for 0.6 of a step."""
    random = np.random.default_rng(5)
    found = []
    for rise in random.uniform(0.02, 1.5, 40):
        steady = np.cumsum(rise * (1.0 + 0.3 * np.sin(np.arange(4000) / 60.0)))
        force = steady % random.uniform(50.0, 70.0) + noise * random.standard_normal(4000)
        found.append(resolved_noise(np.rint(force + random.uniform()), 1.0))
    assert np.median(found) == pytest.approx(noise, abs=0.02)
    # half a step a sample, where differences tell least: 2 v + 2 exp(-4 pi^2 v)/pi^2 is flat
    assert found == pytest.approx(np.full(40, noise), abs=0.15)


@pytest.mark.parametrize("noise", [0.0, 0.1, 0.15, 0.2, 0.3, 0.6])
def test_noise_is_found_on_a_ramp_through_one_code_in_many_samples(noise):
    """More than half of the fourth differences are zero there, and so was their median."""
    random = np.random.default_rng(7)
    for rise in np.geomspace(0.001, 0.05, 6):
        force = rise * np.arange(20_000) % 37.3 + noise * random.standard_normal(20_000)
        # the flips at the edges of codes tell it: some 20 000 rise noise of them, 4 standard errors
        error = 0.02 + 4.0 * noise / (20_000 * rise * max(noise, 0.1)) ** 0.5
        assert resolved_noise(np.rint(force), 1.0) == pytest.approx(noise, abs=min(error, 0.1))


@pytest.mark.parametrize("per_cycle", [12, 16, 20])
def test_slips_in_every_window_are_not_noise(per_cycle):
    random = np.random.default_rng(8)
    saw = 40.0 / per_cycle * (np.arange(4000) % per_cycle)
    for noise in (0.5, 1.0):
        found = resolved_noise(np.rint(saw + noise * random.standard_normal(4000)), 1.0)
        assert found < 3.0 * noise  # a slip of 40 codes is 20 in the differences
        assert dither_remainder(np.rint(saw + noise * random.standard_normal(4000)), 1.0) < 0.01


def test_few_samples_tell_their_noise_without_a_window():
    random = np.random.default_rng(9)
    values = np.rint(3.0 * random.standard_normal(14))
    assert 0.0 <= resolved_noise(values, 1.0) < 20.0
    assert 0.0 <= dither_remainder(values, 1.0) <= 1.0


def test_a_swing_is_no_noise():
    """At a tenth of the sample rate fourth differences leave 0.146 of an amplitude, of 8.4."""
    swing = 1e-2 * np.sin(0.02 * np.pi * np.arange(20000))  # a hundredth of the sample rate
    noise = 1e-4 * np.random.default_rng(1).standard_normal(20000)
    assert noise_level(swing + noise).noise == pytest.approx(1e-4, rel=0.03)


@pytest.mark.parametrize("step", [1e-6, 0.25, 3.0])
def test_a_lattice_is_found_through_the_rounding_of_a_file(step):
    random = np.random.default_rng(2)
    codes = np.rint(20.0 * random.standard_normal(5000))
    written = np.array([float(f"{step * code + 0.7 * step:.6g}") for code in codes])
    assert lattice(written) == pytest.approx(step, rel=1e-4)


def test_values_at_random_are_no_lattice():
    for seed in range(50):
        random = np.random.default_rng(seed)
        assert lattice(random.standard_normal(3000)) == 0.0
        # few different values, each often, at random places
        few = np.sort(random.random(40))
        assert lattice(random.choice(few, 3000)) == 0.0


@pytest.mark.parametrize("order", [1, 2, 4])
def test_differences_of_any_order_give_the_same_noise(order):
    """The median of |x| has a standard error of 1.17 / sqrt(n), more among correlated ones."""
    for seed in range(20):
        values = np.random.default_rng(seed).standard_normal(20000)
        assert white_noise(values, order=order) == pytest.approx(1.0, rel=0.05)
