"""The step between readings: of a converter for sure, or as coarse as it may be."""

import numpy as np
import pytest

from stiction.analysis.signals.digitised import resolution
from stiction.recording.noise import lattice

SINE = np.sin(np.linspace(0.0, 40.0, 200_000))


@pytest.mark.parametrize("bits", range(4, 15))
def test_both_answers_are_one_from_4_to_14_bits(bits):
    """Of 100 000 samples examined there are four for each of 2^14 codes, not of 2^15."""
    step = 2.0 / 2**bits
    values = step * np.rint(SINE / step)
    assert resolution(values) == pytest.approx(step, rel=1e-12)
    assert lattice(values) == pytest.approx(step, rel=1e-12)


def test_a_finer_converter_is_as_good_as_continuous():
    values = np.rint(SINE * 2**15) / 2**15
    assert resolution(values) == lattice(values) == 0.0


def test_of_few_codes_or_samples_the_smallest_step_is_a_bound():
    few = 0.25 * np.rint(4.0 * SINE)
    assert (resolution(few), lattice(few)) == (0.25, 0.0)
    ramp = np.linspace(0.0, 1.0, 101)
    assert resolution(ramp) == pytest.approx(0.01)
    assert lattice(ramp) == 0.0
    assert [resolution(ramp[:count]) for count in (0, 1)] == [0.0, 0.0]


@pytest.mark.parametrize("step", [0.0, 1e-5, 1e-3, 0.1])
@pytest.mark.parametrize("size", [10, 999, 6000])
def test_the_step_does_not_depend_on_the_order_of_values(step, size):
    """Some of the values are examined first, and may decide."""
    values = np.append(SINE[: size * 5 : 5], np.full(size // 3, 0.3))
    values = step * np.rint(values / step) if step else values
    shuffled = np.random.default_rng(1).permutation(values)
    for order in (np.sort(values), values[::-1], shuffled):
        assert lattice(order) == lattice(values)
        assert resolution(order) == resolution(values)
