"""Quick falls are told from noise by their sign."""

import numpy as np
import pytest
from benchmarks.explore.records import irregular_in_noise

from stiction.analysis.motion.changes.quick_falls import EVEN, quick_falls


def slips(number: int) -> np.ndarray:
    record, _, _ = irregular_in_noise(np.random.default_rng([5, number]))
    return record.force


@pytest.mark.parametrize("number", range(4))
def test_slips_are_falls_and_not_rises(number: int) -> None:
    force = slips(number)
    found = quick_falls(force)
    assert found.clearness > EVEN
    assert 0.5 < found.height < 1.5  # the drops are 0.5 to 1.5 N
    for other in (-force, force[::-1]):
        assert quick_falls(other).clearness < EVEN / 2


def test_unit_zero_and_single_wild_samples_make_no_difference() -> None:
    force = slips(0)
    found = quick_falls(force)
    other = quick_falls(1e-3 * force + 7.0)
    assert other.number == found.number
    assert other.height == pytest.approx(1e-3 * found.height, rel=1e-9)
    assert other.times == pytest.approx(found.times, rel=1e-9)
    wild = force.copy()
    wild[100::200] -= 5.0
    assert quick_falls(wild).clearness > EVEN


def test_a_sawtooth_makes_up_its_whole_motion() -> None:
    rng = np.random.default_rng(1)
    force = np.arange(6000) / 200.0 % 1.0 + 0.02 * rng.normal(size=6000)
    found = quick_falls(force)
    assert found.number in (29, 30)
    assert found.times == pytest.approx(12.0**0.5, rel=0.1)  # sd of a uniform distribution
    wanders = quick_falls(force + 3.0 * np.sin(np.arange(6000) / 1000.0))
    assert wanders.number in (29, 30)
    assert wanders.times < 0.5


@pytest.mark.parametrize("size", [1, 5, 31, 64])
def test_few_samples_and_no_noise_have_none(size: int) -> None:
    assert quick_falls(np.ones(size)).clearness == 0.0
    assert quick_falls(np.arange(float(size))).clearness == 0.0
