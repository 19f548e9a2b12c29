"""The rate of loading is that of the part of a rise in which the mass sticks."""

import numpy as np
import pytest
from tests.drawn import inside

import stiction as st
from stiction.analysis.motion.cycles import swings
from stiction.analysis.motion.loading import (
    late_rate,
    loaded_until,
    loading_rate,
    rounding_of_rates,
)

TIME = np.arange(0.0, 12.0, 2e-3)


def rise(corners, noise=0.0, time=TIME):
    """Return the rate found in a rise through some corners (s, N), from the first to the last."""
    at, force = np.array(corners).T
    values = np.interp(time, at, force) + noise * np.random.default_rng(1).normal(size=len(time))
    ends = at[:1], force[:1], at[-1:]
    return float(loading_rate(time, values, at[:1], loaded_until(time, values, *ends))[0])


@pytest.mark.parametrize("noise", [0.0, 0.01, 0.05])
@pytest.mark.parametrize(
    "rest",
    [
        [],
        [(10.0, 1.05)],  # it slides for nine tenths of the time
        [(5.0, 1.0), (5.5, 1.5), (10.0, 1.5)],  # friction grows meanwhile
        [(2.5, 1.0), (3.0, 1.5), (6.0, 1.5), (6.5, 2.0), (10.0, 2.0)],
    ],
)
def test_a_mass_that_slides_before_it_slips_was_loaded_before(rest, noise):
    """Through a tenth to a half of such rises the line rises at 0 to 0.3 N/s.

    Noise hides a bend of three standard deviations.
    """
    found = rise([(0.0, 0.0), (1.0, 1.0), *rest], noise)
    assert found == pytest.approx(1.0, abs=0.01 + 3.0 * noise)


def test_a_loading_in_noise_counts_as_a_whole():
    """Where noise bends it, the rate by a part of the samples alone would be that of noise."""
    rates = [
        rise([(0.0, 0.0), (10.0, 1.0)], noise, np.arange(0.0, 12.0, 10.0 / samples))
        for noise, samples in inside(40, (0.05, 0.3), (10.0, 100.0))
    ]
    assert np.median(rates) == pytest.approx(0.1, rel=0.1)


def test_a_trough_that_noise_makes_bends_no_loading():
    """It is the lowest of some samples: of 100 by 2.5 standard deviations in the median."""
    time, end, whole = np.linspace(0.0, 1.0, 1000), np.array([1.0]), []
    for number in range(100):
        noise = 0.25 * np.random.default_rng([2, number]).normal(size=len(time))
        until = loaded_until(time, time + noise, time[:1], noise[:100].min(keepdims=True), end)
        whole.append(float(until[0]) == 1.0)
    assert np.mean(whole) > 0.9  # 0.98; 0.8 if noise were thought to lift a line by 2.5 of them


def test_a_loading_of_few_samples_in_noise_is_told_from_the_sliding_after_it():
    """In 0.53 of such rises noise hides it, in 0.9 where half of one had to be precise to 5 %."""
    off = []
    for noise, samples in inside(100, (0.01, 0.1), (5.0, 15.0)):
        time = np.arange(0.0, 12.0, 1.0 / samples)
        off.append(abs(rise([(0.0, 0.0), (1.0, 1.0), (10.0, 1.0)], noise, time) - 1.0) > 0.2)
    assert np.mean(off) < 0.56  # 0.59 if eight samples were needed, 0.63 beyond four deviations


def sliding_slips(random, count):
    """Return a record of slips, each after a loading at 1 N/s and sliding for up to 30 s."""
    corners, time, force = [(0.0, 0.0)], 0.0, 0.0
    for _ in range(count):
        top = random.uniform(1.0, 3.0)
        time += top - force
        corners.append((time, top))
        time += random.uniform(0.0, 30.0)
        corners.append((time, top))
        time, force = time + 0.1, random.uniform(0.0, 0.5)
        corners.append((time, force))
    corners.append((time + 0.9, force + 0.9))
    at = np.arange(0.0, corners[-1][0], 0.01)
    values = np.interp(at, *np.array(corners).T) + 2e-3 * random.normal(size=len(at))
    return st.Record(time=at, force=values, stiffness=1e3, drive_velocity=1e-3)


@pytest.mark.parametrize("count", [2, 4])
def test_slips_after_sliding_were_loaded_at_one_rate(count):
    """By a tenth to a half of the time most rates came out at less than half of it."""
    rates = []
    for number in range(20):
        record = sliding_slips(np.random.default_rng([count, number]), count)
        rates += [*swings(record).lasting["stick_slope"]]
    assert len(rates) >= 10 * (count - 1)  # the first slip ends before the first cycle
    assert rates == pytest.approx(np.ones(len(rates)), rel=0.1)


@pytest.mark.parametrize("turns", [0.7, 1.0, 1.5, 2.5])
def test_a_loading_by_a_drive_whose_velocity_varies_counts_as_a_whole(turns):
    """By up to 30 % each way, as of a lead screw: the fastest part of it is no rate of loading."""
    time, start, end = np.arange(0.0, 1.0, 1e-3), np.array([0.0]), np.array([0.999])
    for phase in np.arange(0.0, 2.0 * np.pi, 0.3):
        angle = 2.0 * np.pi * turns * time + phase
        force = time + 0.3 * (np.cos(phase) - np.cos(angle)) / (2.0 * np.pi * turns)
        assert loaded_until(time, force, start, force[:1], end) == end


def test_noise_breaks_up_what_the_steps_of_a_converter_make_alike():
    ramp = np.linspace(0.0, 1.0, 1000)
    coarse, fine = (rounding_of_rates(step * np.rint(ramp / step), 1.0) for step in (0.1, 0.05))
    assert coarse == pytest.approx(2.0**1.5 * fine)
    noise = 0.1 * np.random.default_rng(1).standard_normal(1000)
    assert rounding_of_rates(0.1 * np.rint((ramp + noise) / 0.1), 1.0) < 0.1 * coarse
    assert rounding_of_rates(ramp + noise, 1.0) == 0.0
    assert rounding_of_rates(0.1 * np.rint(ramp / 0.1), 0.0) == 0.0


@pytest.mark.parametrize("quality", [3.0, 8.0, 15.0])
@pytest.mark.parametrize("number", [6.0, 20.0])
def test_a_load_cell_that_rings_after_a_slip_leaves_the_rate_of_loading(quality, number):
    """By the flank of its first swing the rate came out at 3 to 30 times the true one."""
    time = np.arange(0.0, 10.0, 2e-3)
    swing = np.exp(-np.pi * number * time / 10.0 / quality) * np.cos(
        2 * np.pi * number * time / 10.0
    )
    force = 0.1 * time - 0.3 * (swing - 1.0)
    corners = np.stack([time, force], axis=1)
    # the line through a tenth to a half of the time; of few swings that fade the mean is not zero
    for noise in (0.0, 0.03):  # N; the first swing falls by some twenty of them
        assert rise(corners[:-1], noise) == pytest.approx(0.1, rel=0.5)


def test_a_small_slip_in_a_rise_is_no_swing_of_a_load_cell():
    """The force goes on as fast after it; by all of the rise the rate came out at 0.1 N/s."""
    assert rise([(0.0, 0.0), (0.4, 0.4), (0.41, 0.1), (1.3, 1.0)]) == pytest.approx(1.0)


def test_the_late_rate_is_that_of_the_second_half():
    rises = np.tile(np.interp(np.arange(100.0), [0.0, 40.0, 100.0], [0.0, 4.0, 7.0]), 2)
    time, start = np.arange(200.0), np.array([0.0, 100.0])
    assert late_rate(time, rises, start, start + 99.0) == pytest.approx([0.05, 0.05])
    assert loading_rate(time, rises, start, start + 99.0) == pytest.approx([0.1, 0.1], rel=0.1)
    assert np.isfinite(late_rate(time[:3], rises, start[:1], start[:1] + 1.0)).all()  # so short


@pytest.mark.parametrize("number", [411, 585, 641, 2515])
def test_a_fall_by_one_step_makes_no_flank_of_a_swing(number):
    """Rounded, the step of all values is less than some fall by one: so it was in 4 of 3000."""
    random, time = np.random.default_rng(number), np.arange(0.0, 10.0, 0.02)
    rate, step = random.uniform(0.3, 3.0), 10 ** random.uniform(-1.3, -0.5)
    force = 1.0 - np.exp(-rate * time) + random.uniform()
    force += 10 ** random.uniform(-4, -1.3) * random.normal(size=len(time))
    force = step * np.round(force / step)
    until = loaded_until(time, force, np.zeros(1), force[:1], np.array([9.98]))
    assert until[0] < 9.98
