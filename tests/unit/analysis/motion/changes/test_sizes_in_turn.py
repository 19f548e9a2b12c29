"""Large and small slips that alternate are named, and slips that differ by chance are not."""

import numpy as np
import pytest
from tests.drawn import inside

import stiction as st
from stiction.analysis.motion.changes.cycles import sizes_in_turn


def slips(drops, random):
    """Return a record of slips from 3 N by some drops (N), loaded at 1 N/s, in noise of 0.01 N."""
    drops, ends = np.asarray(drops), np.cumsum(drops)
    at = np.stack([ends[:-1] - 0.05, ends[:-1]], axis=1).ravel()
    force = np.stack([np.full(len(ends) - 1, 3.0), 3.0 - drops[1:]], axis=1).ravel()
    time = np.arange(0.3 * drops[0], at[-1] + 0.5 * drops[-1], 4e-3)
    ramp = np.append(at, at[-1] + drops[-1]), np.append(force, 3.0)
    noise = 0.01 * random.normal(size=len(time))
    return st.Record(time=time, force=noise + np.interp(time, *ramp))


def report(drops, random):
    """Return the report of such slips."""
    return " ".join(str(st.analyse(slips(drops, random))).split())


@pytest.mark.parametrize("small", [0.5, 0.7])
def test_large_and_small_slips_alternate(small):
    random = np.random.default_rng(1)
    sizes = np.tile([1.0, small], 16) * random.uniform(0.92, 1.08, 32)
    found = report(sizes, random)
    assert "in turn" in found
    assert f"at least {small}" not in found


def test_a_small_slip_within_each_cycle_is_named():
    random = np.random.default_rng(1)
    found = report(np.tile([1.0, 0.3], 16) * random.uniform(0.95, 1.05, 32), random)
    assert "Within nearly each cycle it falls once more, by about 3" in found
    one = report(random.uniform(0.95, 1.05, 32), random)
    mixed = report(random.uniform(0.3, 1.0, 32), random)
    for other in (one, mixed):
        assert "once more" not in other
        assert "in turn" not in other


def test_drops_that_differ_by_chance_do_not_alternate():
    """Independent ones, ones alike their neighbours, and ones that grow."""
    for number, (spread, alike) in enumerate(inside(300, (0.05, 0.5), (0.0, 0.95))):
        values = np.random.default_rng(number).normal(size=40)
        for at in range(1, 40):
            values[at] += alike * values[at - 1]
        assert sizes_in_turn(np.exp(spread * values)) is None
        assert sizes_in_turn(np.exp(spread * values) + 0.3 * np.arange(40.0)) is None


@pytest.mark.parametrize(("pairs", "small", "seen"), [(10, 0.5, 0), (11, 0.5, 1), (11, 0.9, 0)])
def test_enough_sizes_that_differ_enough_alternate(pairs, small, seen):
    """Ten large ones with both of their neighbours, a fifth larger."""
    for drops in (np.tile([1.0, small], pairs), np.tile([small, 1.0], pairs)):
        assert (sizes_in_turn(drops) is not None) == seen
    one_off = np.tile([1.0, 0.5], 12)
    one_off[8] = 0.4
    assert sizes_in_turn(one_off) == (1.0, 0.5)
    one_off[14] = 0.4
    assert sizes_in_turn(one_off) is None
