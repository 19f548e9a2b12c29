"""Swings of a load cell after each slip are told by the number by which they fade."""

from itertools import pairwise

import numpy as np
import pytest
from benchmarks.explore import records
from benchmarks.explore.numbers import FAMILIES, compare
from scipy.signal import bilinear, lfilter, lfilter_zi
from tests.drawn import inside
from tests.parts import assess

import stiction as st
from stiction.analysis.motion.cycles import swings
from stiction.analysis.motion.load_cell.free_swings import (
    free_swing,
    ringing_cell,
    without_free_swings,
)
from stiction.analysis.signals.even_grid import even_grid

TIME = np.arange(0.0, 60.0, 2e-3)  # s
GRID = even_grid(TIME)
HARD = FAMILIES["cell that rings for long"]


def slips(drops):
    """Return a force that slips from 1 N by a drop (N) every 2 s, or less after a smaller one."""
    ends = np.cumsum(2.0 * np.asarray(drops))
    at = np.ravel([[end - 0.1, end] for end in ends])
    force = np.ravel([[1.0, 1.0 - after] for _, after in pairwise([*drops, 1.0])])
    return np.interp(TIME, np.append(0.0, at), np.append(1.0 - drops[0], force))


def through_cell(force, frequency, quality):
    """Return what a load cell makes of a force; it swings at a frequency, Hz."""
    turns = 2.0 * np.pi * frequency
    cell = bilinear([turns**2], [1.0, turns / quality, turns**2], 500.0)
    return lfilter(*cell, force, zi=lfilter_zi(*cell) * force[0])[0]


@pytest.mark.parametrize("number", range(4))
def test_frequency_and_quality_of_a_load_cell_come_out(number):
    """Noise of 2 % of a slip; a first guess of the period may be off by a third."""
    random = np.random.default_rng(number)
    noise = 0.02 * random.normal(size=len(TIME))
    for frequency, quality, guess in inside(10, (2.0, 6.0), (5.0, 40.0), (0.75, 1.35)):
        force = through_cell(slips(random.uniform(0.6, 1.4, 40)), frequency, quality) + noise
        found = free_swing(GRID, force, [guess / frequency])
        assert found.frequency == pytest.approx(frequency, rel=0.01)
        assert found.quality == pytest.approx(quality, rel=0.2)


@pytest.mark.parametrize("number", range(4))
def test_the_load_cell_comes_out_whatever_part_of_a_mean_its_period_is(number):
    """Its swings were drawn to whole means of samples: frequencies were off by up to 1 %."""
    random = np.random.default_rng(number)
    noise = 0.002 * random.normal(size=len(TIME))
    for frequency, quality, guess in inside(10, (2.0, 6.0), (4.0, 40.0), (0.75, 1.35)):
        force = through_cell(slips(random.uniform(0.6, 1.4, 40)), frequency, quality) + noise
        found = ringing_cell(force, free_swing(GRID, force, [guess / frequency]), 1.0)
        assert found.frequency == pytest.approx(frequency, rel=2e-3)
        assert found.quality == pytest.approx(quality, rel=0.04)


def test_the_force_to_which_a_cell_answered_is_without_its_swings():
    given = slips(np.random.default_rng(1).uniform(0.6, 1.4, 40))
    seen = through_cell(given, 4.0, 30.0)
    cell = ringing_cell(seen, free_swing(GRID, seen, [0.25]), 1.0)
    answered = without_free_swings(GRID, seen, cell)
    inside = slice(500, -500)  # of the first and last second something is left
    assert np.std((seen - given)[inside]) > 0.15
    assert np.std((answered - given)[inside]) < 0.015


@pytest.mark.parametrize(("quality", "rings"), [(2.2, False), (3.6, True), (55, True), (90, False)])
def test_a_swing_that_fades_at_once_or_hardly_is_not_that_of_a_cell(quality, rings):
    seen = through_cell(slips(np.random.default_rng(1).uniform(0.6, 1.4, 40)), 4.0, quality)
    assert (free_swing(GRID, seen, [0.25]) is not None) == rings


@pytest.mark.parametrize(("noise", "left"), [(0.0, 0.007), (0.003, 0.12), (0.01, 0.12)])
def test_noise_is_amplified_to_a_tenth_of_a_slip_at_most(noise, left):
    """And the force is restored up to six times the frequency of the cell where it has none."""
    random = np.random.default_rng(1)
    given = slips(random.uniform(0.6, 1.4, 40))
    seen = through_cell(given, 4.0, 30.0) + noise * random.normal(size=len(TIME))
    cell = ringing_cell(seen, free_swing(GRID, seen, [0.25]), 1.0)
    answered = without_free_swings(GRID, seen, cell)
    assert np.std((answered - given)[500:-500]) < left


def test_small_slips_after_a_large_one_are_not_swings():
    """Slips of 1, 0.5, 0.25, 0.125 N and again: each takes a time of its own."""
    sizes = np.tile([1.0, 0.5, 0.25, 0.125], 16)
    noise = 0.01 * np.random.default_rng(1).normal(size=len(TIME))
    record = st.Record(time=TIME, force=slips(sizes) + noise)
    periods = 2.0 * np.array([1.0, 0.5, 0.25, 0.125, 0.1])
    assert free_swing(GRID, record.force, periods) is None
    assert swings(record).cell is None


@pytest.mark.parametrize(
    "make",
    [
        records.harmonic, records.short, records.long, records.wandering, records.settling,
        records.brief_vibration, records.brief_harmonic, records.few_samples, records.on_a_wave,
    ],
)  # fmt: skip
def test_vibrations_are_not_those_of_a_load_cell(make):
    """Nor was one of 30 further records of each family, by which no constant was set."""
    for number in range(8):
        record, *_ = make(np.random.default_rng([6, number]))
        assert swings(record).cell is None


@pytest.mark.parametrize(("make", "number"), [(records.hum, 17), (records.random_times, 39)])
def test_hum_is_not_that_of_a_load_cell(make, number):
    """In noise its swings seem to fade, at 49.5 Hz, of a quality of 23 and 57."""
    record, count, _ = make(np.random.default_rng([6, number]))
    found = swings(record)
    assert found.cell is None
    assert abs(len(found.table) - count) <= 1


@pytest.mark.parametrize("number", [0, 3, 13, 19, 25, 48])
def test_swings_of_a_load_cell_are_not_cycles(number):
    """They were, 3 to 17 times as many, of a vibration without static friction."""
    known = HARD(np.random.default_rng([501, number]))
    found = st.analyse(known.record)
    assert found.regime.kind == "stick-slip"
    assert abs(found.cycles.sizes["cycle"] - len(known.peak) + 1) <= 1
    compared = {each.quantity: each for each in compare(known, found)}
    for name in ("µ static", "µ kinetic"):
        its = compared[name]
        assert abs(its.found - its.true) < 3.0 * its.error
    assert "as where the load cell rings" in " ".join(found.warnings)


def test_steps_of_a_converter_are_an_error_where_a_cell_rings_too():
    known = HARD(np.random.default_rng([501, 19]))
    step = 0.1 * float((known.peak - known.trough).mean())
    coarse = known.record.with_force(step * np.rint(known.record.force / step))
    fine, found = (assess(each).friction.static for each in (known.record, coarse))
    assert found.error > fine.error


@pytest.mark.parametrize("samples", [1, 2, 3, 4])
def test_slips_of_a_few_samples_show_no_swing(samples):
    """A swing of one turn a sample looks like a constant: `analyse` ended in a singular matrix."""
    assert free_swing(GRID, slips([1.0] * 40), [samples * GRID.step]) is None
