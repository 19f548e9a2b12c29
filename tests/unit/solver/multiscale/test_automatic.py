"""Where a map is tried by default, and given up; and that nothing but its cost depends on that."""

import numpy as np
import pytest
from benchmarks.explore.systems.set_valued import system

import stiction as st
from stiction.solver.integrate import integrate
from stiction.solver.multiscale.automatic import (
    CYCLES,
    LOSS,
    WORTH,
    Automatic,
    Leg,
    MapTrial,
    trial,
)
from stiction.solver.state import NOTHING, Motion, State

PAPER = st.presets.nakano_popov_2020()
LONG = 5.0  # s; some 23 000 steps


def state_at(t, sticks=0):
    return State(Motion(t, 0.0, 0.0, 0.0, 1.0, 0.0), None, NOTHING._replace(sticks=sticks))


def steps_of(statistics):
    return statistics.steps + statistics.rejected


@pytest.mark.parametrize("start", [0.0, 3.0])
def test_what_a_map_may_cost(start):
    """(M58a): of what steps would still cost, less some that is lost; and of those of the leg."""
    leg, now = Leg(1000, 0, state_at(start, 7)), state_at(start + 0.1, 57)
    expects = start + 0.1 + 0.1 * np.array([0.99, 1.01, 10.0, 20.0]) * WORTH / 1000
    assert trial(leg, now, expects[0], 0) is None
    stakes = LOSS * 1.01 * WORTH, 1000, 10 * LOSS * WORTH - 1100
    for until, lost, stake in zip(expects[[1, 2, 2]], (0, 0, 1100), stakes, strict=True):
        found = trial(leg, now, until, lost)
        assert found == MapTrial(pytest.approx(stake, abs=1), 20, 1000)
    assert trial(leg, now, expects[2], round(10 * LOSS * WORTH) + 1) is None
    assert trial(leg, state_at(start + 0.1, 7 + CYCLES), expects[3], 0) is not None
    assert trial(leg, state_at(start + 0.1, 6 + CYCLES), expects[3], 0) is None


def test_a_long_run_is_mapped_and_as_right_as_in_steps():
    run, steps = (
        st.simulate(PAPER, LONG, sample_rate=0, **way) for way in ({}, {"multiscale": False})
    )
    assert steps.statistics.mapped == 0
    assert run.statistics.mapped > 0.8 * run.statistics.stick_count
    assert steps_of(run.statistics) < 0.3 * steps_of(steps.statistics)
    assert run.statistics.stick_count == steps.statistics.stick_count
    assert float(run.final["u_x"]) == pytest.approx(float(steps.final["u_x"]), rel=2e-6)
    assert "multiscale" in run.data.attrs["solver"]
    assert "multiscale" not in steps.data.attrs["solver"]


@pytest.mark.parametrize(
    "slider",
    [
        PAPER.replace(phi="0 deg"),  # it sticks and slips some ten times
        PAPER.replace(c_y="400 N s/m"),  # sticks end with the first oscillations
        PAPER.replace(
            drive=st.protocols.DriveProgram(
                velocity="1 mm/s", across=st.protocols.Modulation("0.1 mm/s", "50 Hz")
            )
        ),
    ],
    ids=["aligned", "damped", "shaken"],
)
def test_where_there_is_nothing_to_map_the_run_is_that_in_steps(slider):
    """To the last bit."""
    run, steps = (
        st.simulate(slider, 1.0, sample_rate=0, multiscale=way) for way in ("auto", False)
    )
    assert run.statistics == steps.statistics
    assert run.data["u_y"].values.tolist() == steps.data["u_y"].values.tolist()
    assert run.stick_intervals.tolist() == steps.stick_intervals.tolist()


def test_neither_samples_nor_pauses_change_the_motion():
    """Blocks pause a run every 5 000 turns, and samples take nodes of their own."""
    run = st.simulate(PAPER, LONG, sample_rate=0)
    sampled = st.simulate(PAPER, LONG, sample_rate=2e3)
    times, blocks = sampled.data["time"].values, []
    paused = integrate(run.description, times, 10**8, None, lambda rows: blocks.append(rows.copy()))
    for sticks in (sampled.stick_intervals, paused.sticks):
        assert sticks.tolist() == run.stick_intervals.tolist()
    assert sampled.data["u_x"].values[-1] == run.data["u_x"].values[-1]
    assert np.concatenate(blocks)[:, 0].tolist() == sampled.data["u_x"].values.tolist()


LONGER = 30.0  # times as long as the random systems are


def test_maps_that_do_not_pay_cost_little():
    """Each no more than its stakes, and all together less than what is allowed each."""
    cost, steps = np.array([cost_of(number) for number in range(60)]).T
    assert np.all(cost < 1.5 * steps)
    dear = cost > 0.98 * steps
    assert 20 < dear.sum() < 60
    assert cost[dear].sum() < (1.0 + LOSS) * steps[dear].sum()


def cost_of(number):
    """Return the steps of a long run by default, and all in steps."""
    slider, duration, rtol = system(61, number)[:3]
    settings = {"duration": LONGER * duration, "sample_rate": 0, "rtol": rtol}
    ways = ("auto", False)
    return [steps_of(st.simulate(slider, **settings, multiscale=way).statistics) for way in ways]


@pytest.mark.parametrize(("left", "lost"), [(3, None), (0, None), (-1, 11), (-7, 17)])
def test_a_map_that_has_cost_too_much_is_left_for_another_leg(left, lost):
    solver, tried_map = Automatic(PAPER, 1e-6), MapTrial(10, 5, 512)
    after = solver.after_map(tried_map, left, state_at(1.0))
    assert (after is tried_map) == (lost is None)
    if lost is not None:
        assert after[:2] == (1024, 1024)
        assert solver.lost == lost
