"""Quick falls are told from noise by their sign."""

import numpy as np
import pytest
from benchmarks.explore.records import irregular_in_noise

from stiction.analysis.motion.changes.quick_falls import EVEN_CHANCE, QuickFalls, quick_falls


def slips(number: int) -> np.ndarray:
    record, _, _ = irregular_in_noise(np.random.default_rng([5, number]))
    return record.force


def falls(force: np.ndarray) -> QuickFalls:
    return quick_falls(5e-3 * np.arange(len(force)), force)


@pytest.mark.parametrize("number", range(4))
def test_slips_are_falls_and_not_rises(number: int) -> None:
    force = slips(number)
    found = falls(force)
    assert found.clearness > EVEN_CHANCE
    assert 0.5 < found.height < 1.5  # the drops are 0.5 to 1.5 N
    for other in (-force, force[::-1]):
        assert falls(other).clearness < EVEN_CHANCE / 2


def test_unit_zero_and_single_wild_samples_make_no_difference() -> None:
    force = slips(0)
    found = falls(force)
    other = falls(1e-3 * force + 7.0)
    assert other.number == found.number
    assert other.height == pytest.approx(1e-3 * found.height, rel=1e-9)
    assert other.times == pytest.approx(found.times, rel=1e-9)
    wild = force.copy()
    wild[100::200] -= 5.0
    assert falls(wild).clearness > EVEN_CHANCE
    assert falls(wild).height == pytest.approx(found.height, rel=0.1)


def test_a_sawtooth_makes_up_its_whole_motion() -> None:
    rng = np.random.default_rng(1)
    force = np.arange(6000) / 200.0 % 1.0 + 0.02 * rng.normal(size=6000)
    found = falls(force)
    assert found.number in (29, 30)
    assert found.times == pytest.approx(12.0**0.5, rel=0.1)  # sd of a uniform distribution
    wanders = falls(force + 3.0 * np.sin(np.arange(6000) / 1000.0))
    assert wanders.number in (29, 30)
    assert wanders.times < 0.5


@pytest.mark.parametrize("size", [1, 5, 31, 64, 1000, 20000])
@pytest.mark.parametrize("step", [1.0, -0.1, 1e-9 / 3.0, 1e6 / 7.0])
def test_few_samples_and_no_noise_have_none(size: int, step: float) -> None:
    assert falls(np.full(size, step)).clearness == 0.0
    assert falls(step * np.arange(float(size))).clearness == 0.0


@pytest.mark.parametrize("noise", [0.0, 0.2, 0.35])  # of a step: noise of half a step leaves none
def test_a_force_that_drifts_down_the_steps_of_a_converter_has_none(noise: float) -> None:
    noises = noise * np.random.default_rng(2).normal(size=6000)
    drifts = 500.0 - np.arange(6000) / 270.0 + noises
    assert falls(np.rint(drifts)).clearness == 0.0
    assert falls(np.rint(drifts - 4.0 * (np.arange(6000) / 200.0 % 1.0))).clearness < EVEN_CHANCE
    assert falls(np.rint(drifts + 4.0 * (np.arange(6000) / 200.0 % 1.0))).clearness > EVEN_CHANCE


def test_irregular_slips_by_one_step_of_a_converter_are_seen() -> None:
    for number in (0, 1):
        assert falls(np.rint(slips(number))).clearness > EVEN_CHANCE


def test_what_a_force_falls_by_in_a_gap_is_not_quick() -> None:
    number = np.arange(12000)
    time = 5e-3 * number[number % 200 < 190]
    noise = 1e-3 * np.random.default_rng(3).normal(size=len(time))
    assert quick_falls(time, 2.0 - time + noise).clearness < EVEN_CHANCE / 2
    saw = time % 0.7 + noise
    assert quick_falls(time, saw).clearness > EVEN_CHANCE
    rare = number[: len(time)] % 100 < 20  # no spectrum, either
    assert quick_falls(time[rare], 2.0 - time[rare] + noise[rare]).clearness == 0.0


@pytest.mark.parametrize("number", range(4))
def test_a_wave_25_times_as_high_hides_none(number: int) -> None:
    force = slips(number)
    wave = 12.5 * np.sin(np.linspace(0.0, 20.0, len(force)))
    found = falls(force + wave)
    assert found.clearness > EVEN_CHANCE
    assert 0.5 < found.height < 1.5


@pytest.mark.parametrize("period", [4.0, 4.3, 20.0, 40.0])  # of few phases the median is by chance
def test_noise_and_a_vibration_have_none(period: float) -> None:
    rng, turns = np.random.default_rng(4), np.arange(3000) / period
    for phase in range(6):
        noise = rng.normal(size=3000)
        hum = np.sin(2.0 * np.pi * turns + phase)
        for force in (noise, noise**3, np.cumsum(noise), hum + 0.03 * noise, hum + 0.3 * noise):
            assert falls(force).clearness < EVEN_CHANCE


@pytest.mark.parametrize(("skew", "seen"), [(0.02, False), (0.08, True)])
def test_a_vibration_that_falls_hardly_quicker_than_it_rises_has_none(
    skew: float, seen: bool
) -> None:
    turns = 2.0 * np.pi * np.arange(3000) / 20.0
    noise = 0.03 * np.random.default_rng(5).normal(size=3000)
    force = np.sin(turns) - skew * np.sin(2.0 * turns) + noise
    assert (falls(force).clearness > EVEN_CHANCE) == seen


def test_falls_have_most_of_their_height_and_those_of_half_of_it_count() -> None:
    drops = np.where(np.arange(40) % 5, 1.0, 0.5)
    ends = 100.0 * np.cumsum(drops)
    knots = np.ravel([ends - 20.0, ends], "F")
    force = np.interp(np.arange(ends[-1]), knots, np.ravel([0.8 * drops, np.zeros(40)], "F"))
    found = falls(force + 0.02 * np.random.default_rng(6).normal(size=len(force)))
    assert found.number == pytest.approx(40, abs=1)
    assert found.height == pytest.approx(0.8, rel=0.25)
