"""The rate of loading is that of the part of a rise in which the mass sticks."""

import numpy as np
import pytest
from tests.drawn import inside
from tests.parts import assess

import stiction as st
from stiction.analysis.motion.cycles import swings
from stiction.analysis.motion.loading import (
    late_rate,
    loaded_until,
    loading_rate,
    rounding_of_rates,
    swings_of_cell,
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


def swings_after(slips):
    """Return what rises from 0 N, (n, samples) each over 10 s, show of the swings of a cell."""
    count, samples = slips.shape
    time = np.arange(count * samples) * 10.0 / samples
    start = time[::samples]
    peak_time = time[samples - 1 :: samples]
    return swings_of_cell(time, slips.ravel(), start, slips[:, 0], peak_time)


@pytest.mark.parametrize("quality", [3.0, 8.0])
@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_a_trough_is_too_low_by_the_first_swing_of_a_load_cell(quality, noise):
    """The rise begins 0.3 N too low; of a peak nothing is seen but what a radian of it hides."""
    time = np.arange(0.0, 10.0, 5e-3)
    phase = 4.0 * np.pi * time
    rise = 0.1 * time - 0.3 * np.exp(-0.5 * phase / quality) * np.cos(phase)
    rises = rise + noise * np.random.default_rng(1).normal(size=(6, len(time)))
    found = swings_after(rises)
    assert found.trough == pytest.approx(0.3, abs=0.02 + 2.0 * noise)
    assert found.peak == pytest.approx(0.1 / (4.0 * np.pi), abs=1e-3 + 3.0 * noise)
    assert found.rate < 0.01


def test_a_load_cell_rings_if_most_rises_do():
    """And what it does is that of those: of a rise that does not, the trough is right."""
    time = np.arange(0.0, 10.0, 5e-3)
    swing = np.exp(-time) * np.cos(4.0 * np.pi * time)
    sizes = np.linspace(0.2, 0.4, 7)
    for silent, rings in ((9, False), (5, True)):
        rises = 0.1 * time - np.append(sizes, np.zeros(silent))[:, None] * swing
        found = swings_after(rises)
        assert (found is not None) is rings
    assert found.trough == pytest.approx(0.3, abs=0.01)


def test_what_is_left_of_a_swing_at_the_peak_is_its_error_there():
    time = np.arange(0.0, 10.0, 5e-3)
    rise = 0.1 * time - 0.3 * np.exp(-time) * np.cos(4.0 * np.pi * time)
    rise[-20:] += 0.05
    assert swings_after(np.tile(rise, (6, 1))).peak == pytest.approx(0.05, abs=5e-3)


def test_a_swing_that_fades_late_is_off_in_the_rate():
    """The line through the whole rise has it; that through its second half hardly."""
    time = np.arange(0.0, 10.0, 5e-3)
    rises = np.tile(0.1 * time - 0.3 * np.exp(-time / 1.5) * np.cos(1.3 * np.pi * time), (6, 1))
    found = swings_after(rises)
    ends = 10.0 * np.arange(6)
    whole = loading_rate(5e-3 * np.arange(rises.size), rises.ravel(), ends, ends + 9.995)
    assert found.rate == pytest.approx(abs(whole[0] - 0.1), rel=0.1)
    assert found.rate > 5e-3


def test_steps_of_a_coarse_converter_do_not_ring():
    """A fall by one step is 0.3 N but for rounding, and was more than that of the converter."""
    time, random = np.arange(0.0, 10.0, 0.02), np.random.default_rng(0)
    creeps = 1.0 - np.exp(-0.5 * time) + random.uniform(size=(9, 1))
    creeps += 0.01 * random.normal(size=creeps.shape)
    assert swings_after(0.3 * np.round(creeps / 0.3)) is None


def test_a_load_cell_does_not_ring_where_the_mass_creeps_or_slips_a_little():
    """Nor does noise look like it, nor the friction that grows while a mass slides."""
    time, random = np.arange(0.0, 10.0, 0.02), np.random.default_rng(1)
    small = np.interp(time, [0.0, 6.0, 6.1, 10.0], [0.0, 0.6, 0.4, 0.79])
    early = np.interp(time, [0.0, 3.0, 3.1, 10.0], [0.0, 0.3, 0.1, 0.79])
    creeps = 1.0 - np.exp(-0.5 * time)
    slides = np.interp(time, [0.0, 1.0, 5.0, 5.5, 10.0], [0.0, 1.0, 1.0, 1.5, 1.5])
    for shape in (0.1 * time, small, early, creeps, slides):
        for noise in (0.0, 0.01, 0.1):
            assert swings_after(shape + noise * random.normal(size=(9, len(time)))) is None


def test_friction_and_rate_of_loading_by_a_load_cell_that_rings():
    """Of eight slips from 2 to 1 N kinetic friction was 1.38 ± 0.005 N, a load cell too low."""
    time = np.arange(0.0, 80.0, 0.02)
    since = time % 10.0
    fall = 0.5 + 0.5 * np.cos(np.pi * np.clip((since - 9.7) / 0.3, 0.0, 1.0))
    swing = np.exp(-since / 1.3) * np.sin(2.0 * np.pi * since / 1.1) * (since < 9.7)
    force = np.where(since < 9.7, 1.0 + since / 9.7, 1.0 + fall) - 0.35 * swing
    force += 5e-3 * np.random.default_rng(1).normal(size=len(time))
    record = st.Record(time=time, force=force, stiffness=1e3, drive_velocity=1e-3 / 9.7)
    found = assess(record)
    for its, true in ((found.friction.static, 2.0), (found.friction.kinetic, 1.5)):
        assert abs(its.force - true) < 2.0 * its.error < 0.3
    assert [each.agrees for each in found.stated[:1]] == [True]
    assert found.stated[0].error > 8e-3  # N/s, nearly all by the swings
    assert "After each slip the force swings" in " ".join(found.warnings)


def test_the_late_rate_is_that_of_the_second_half():
    rises = np.tile(np.interp(np.arange(100.0), [0.0, 40.0, 100.0], [0.0, 4.0, 7.0]), 2)
    time, start = np.arange(200.0), np.array([0.0, 100.0])
    assert late_rate(time, rises, start, start + 99.0) == pytest.approx([0.05, 0.05])
    assert loading_rate(time, rises, start, start + 99.0) == pytest.approx([0.1, 0.1], rel=0.1)
    assert np.isfinite(late_rate(time[:3], rises, start[:1], start[:1] + 1.0)).all()  # so short
