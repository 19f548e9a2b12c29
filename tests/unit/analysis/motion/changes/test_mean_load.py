"""A load that varies, and the force that follows it or does not."""

import numpy as np
import pytest
from benchmarks.explore.records import (
    brief_slips,
    judge,
    sliding_under_load,
    varying_load,
)

import stiction as st
from stiction.analysis.motion.changes.mean_load import followed_load, under_mean_load
from stiction.analysis.motion.regime.kinds import STEADY

SEED, TIME = 7, np.linspace(0.0, 60.0, 6001)


def sliding(number: int) -> tuple[st.Record, float]:
    """Return a record of sliding at a friction coefficient of 0.3, and the mean load, N."""
    random = np.random.default_rng([SEED, number])
    load = 20.0 * varying_load(random, TIME)
    force = 0.3 * load + 0.005 * random.normal(size=len(TIME))
    return st.Record(time=TIME, force=force, load=load), float(load.mean())


def test_swings_of_the_load_are_no_motion() -> None:
    found = [judge(sliding_under_load, SEED, number) for number in range(200)]
    assert sum(each.counted for each in found) >= 196
    assert sum(each.right for each in found) >= 196


def test_the_coefficient_is_that_of_each_instant() -> None:
    for number in range(8):
        record, load = sliding(number)
        found = st.analyse(record)
        assert found.regime.kind == STEADY
        assert found.cycles.sizes["cycle"] == 0
        assert found.friction.kinetic.coefficient == pytest.approx(0.3, abs=1e-4)
        followed = followed_load(record)
        assert followed.slope == pytest.approx(0.3, abs=1e-3)
        steady = under_mean_load(record)
        assert steady.force == pytest.approx(0.3 * load, abs=0.05)
        assert st.analysis.classify(record) == found.regime
        (said,) = found.warnings
        assert "and the force follows it, by 0.3 of it" in said


def test_levels_under_a_load_that_varies_are_those_under_its_mean() -> None:
    random = np.random.default_rng([SEED, 0])
    load = 10.0 * (1.0 + 0.2 * np.sin(2.0 * np.pi * TIME / 3.7))
    friction = 0.3 * load + 0.12 * (TIME > 30.0)
    for zero in (0.0, 0.5):  # with which force over load varies as the load does
        force = friction + zero + 0.005 * random.normal(size=len(TIME))
        found = st.analyse(st.Record(time=TIME, force=force, load=load))
        assert found.regime.evidence["levels"] == 2
        assert found.parts["changes"]["force"].values == pytest.approx(
            np.array([3.0, 3.12]) + zero, abs=0.01
        )


def test_the_load_of_slips_is_left_alone() -> None:
    """Friction tilts a rig, so that its load follows each slip, by less than a tenth of it."""
    for number in range(20):
        record, count, _ = brief_slips(np.random.default_rng([SEED, number]))
        tilted = st.Record(time=record.time, force=record.force, load=30.0 + 0.1 * record.force)
        assert under_mean_load(tilted) is tilted
        assert abs(st.analysis.find_cycles(tilted).sizes["cycle"] - count) <= 1


def test_slips_under_a_load_that_varies_stay() -> None:
    for number in range(40):
        random = np.random.default_rng([SEED, number])
        record, count, _ = brief_slips(random)
        load = 20.0 * varying_load(random, record.time - record.time[0])
        both = st.Record(time=record.time, force=record.force, load=load)
        assert under_mean_load(both) is both
        assert abs(st.analysis.find_cycles(both).sizes["cycle"] - count) <= 1


def test_a_constant_load_and_a_run_have_none() -> None:
    record, load = sliding(0)
    constant = record.model_copy(update={"load": np.full(len(TIME), load)})
    assert followed_load(constant) is None
    assert followed_load(record.model_copy(update={"load": None})) is None
    lifts = record.model_copy(update={"load": record.load - record.load.min() - 1.0})
    assert followed_load(lifts) is None
