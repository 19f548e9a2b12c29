"""The least p-value that a test can give, beside the threshold at which it finds something."""

import numpy as np
import pytest
from tests.uncertain import record_of

from stiction.inference.cycles import LEAST_CYCLES, slip_cycles
from stiction.inference.disagreement import TWO_WAYS
from stiction.inference.fit import FEWEST_SIMULATIONS
from stiction.inference.learning.conflict import NEAREST, Conflict
from stiction.inference.mechanism.likeness import BENT, CURVES
from stiction.inference.observation import TREND, observe, steadiness, trend, trend_of
from stiction.inference.posterior import CONTRADICTS, RARE, at_most, other_rate
from stiction.inference.predictive import DRAWS


def test_no_test_of_a_fit_is_blind_for_lack_of_simulations():
    """The least p-value of n simulations, 1/(n + 1), lies below each threshold."""
    assert TWO_WAYS / (FEWEST_SIMULATIONS + 1) < CONTRADICTS
    assert NEAREST <= FEWEST_SIMULATIONS
    assert 1.0 / (NEAREST + 1) < CONTRADICTS
    assert 1.0 / (DRAWS / 2 + 1) < RARE  # at least half of them have cycles
    assert 1.0 / (CURVES + 1) < BENT


@pytest.fixture(scope="module")
def seen(rig):
    """A record whose peaks and drops have no trend."""
    return observe(record_of(rig.slider.replace(phi="2.5 deg"), 7), rig.slider)


def with_sizes(seen, sizes):
    """Return the observation with cycles of these sizes in place of its own."""
    force = np.concatenate([np.r_[0.0:1.0:9j, 0.5] * size for size in sizes])
    return seen._replace(force=force, cycles=slip_cycles(force))


@pytest.mark.parametrize("records", [1, 2, 4, 8])
def test_six_cycles_that_grow_in_each_of_several_records_are_a_trend(seen, records):
    """The least p-value times the number of records, 0.011 of four, was never below 0.01."""
    growing = with_sizes(seen, 1.0 + 0.05 * np.arange(LEAST_CYCLES + 2))
    assert len(growing.cycles.peak) == LEAST_CYCLES
    assert 4 * trend(growing.force, growing.cycles).drops > TREND
    found = trend_of([growing] * records)
    assert max(found) < TREND
    assert steadiness(found) < TREND


def test_several_records_without_a_trend_seldom_show_one(seen):
    random, found = np.random.default_rng(7301), []
    for _ in range(400):
        sizes = 1.0 + 0.05 * random.standard_normal((3, 9))
        found.append(trend_of([with_sizes(seen, each) for each in sizes]))
    shares = (np.array(found) < TREND).mean(axis=0)
    assert (shares <= TREND + 3.0 * (TREND / 400) ** 0.5).all()


def test_a_share_of_no_simulation_is_a_bound():
    """ "0.5 % of the simulated records are as far off" was said where none was."""
    assert at_most(2.0 / 201.0, 1.0 / 201.0) == "1 %"
    conflict = Conflict(0.05, 0.005, 1.0 / (NEAREST + 1.0))
    assert "drive velocity: at most 0.5 % of the simulated records" in other_rate(conflict)
