"""Cycles solved in full, and patches of the return map made of them."""

from functools import cache

import numpy as np
import pytest
from tests.entry import map_of, plain
from tests.unit.solver.exact.test_predictor import COLD
from tests.unit.solver.exact.test_step import held_to

import stiction as st
from stiction.solver.exact import loop
from stiction.solver.exact.record import Sink, record_of
from stiction.solver.multiscale import construction, interpolant, section
from stiction.solver.multiscale.return_map import WIDEST
from stiction.solver.segments import segments
from stiction.solver.state import NOTHING, Counts, Motion, State

# the paper's, but hardly stiff across: some ten steps a cycle, a hundred cycles a second
SOFT = st.presets.nakano_popov_2020().replace(k_y=1e5)
MEMORY = COLD._replace(h=1e-5, plan=(1e-5, *[0.0] * 7))
EXACT = held_to(1e-9)
THETAS = [0.5, 1.0, 1.3]
MOST = 10_000  # turns of the loop


@cache
def problem_of(name):
    """Return what the solver works on."""
    damped = SOFT.replace(c_x=2.0, c_y=3.0)
    return next(segments({"soft": SOFT, "damped": damped}[name], 0.0, 10.0)).problem


def taking_off(problem, theta, t=0.0):
    """Return the state at the end of a stick."""
    u = plain(section.elongation_held)(problem, theta)
    return State(Motion(t, *u, 0.0, 1.0, 0.0), MEMORY, NOTHING)


def cycle_from(problem, known, theta):
    """Return the cycle from an angle."""
    return plain(construction.solve_cycle)(problem, EXACT, MEMORY, known, theta, 1.0, MOST)[1]


def step_through(problem, theta, count):
    """Return the stick intervals after a take-off, by steps, and the angles at their ends."""
    sticks, state = np.zeros((count, 2)), taking_off(problem, theta)
    sink = Sink(np.empty(0), np.empty((0, 7)), sticks, record_of(0))
    exact = EXACT._replace(touch=0.0)
    plain(loop.take_steps)(problem, state, 9.0, exact, 10**6, sink, 0)
    return sticks


@pytest.mark.parametrize("name", ["soft", "damped"])
@pytest.mark.parametrize("theta", THETAS)
def test_a_cycle_from_an_angle(name, theta):
    """From one stick's end to the next one's, as steps find it; and nothing else is left behind."""
    problem, known = problem_of(name), map_of(1e-6)
    found, cycle, swing, end, turns = plain(construction.solve_cycle)(
        problem, EXACT, MEMORY, known, theta, 1.0, MOST
    )
    assert found
    ((start, until),) = step_through(problem, theta, 1)
    assert cycle.held == pytest.approx(until - start, rel=1e-6)
    assert cycle.time == pytest.approx(until, rel=1e-6)
    v = problem.drive.velocity * np.array([problem.system.cos_phi, problem.system.sin_phi])
    u = np.array(end.motion[1:3]) + cycle.held * v
    assert section_angle(problem, u) == pytest.approx(theta + cycle.turn, abs=1e-9)
    assert u == pytest.approx(plain(section.elongation_held)(problem, theta + cycle.turn))
    landed = section_angle(problem, end.motion[1:3])
    assert swing == pytest.approx(section_angle(problem, u) - landed)
    assert end.counts.sticks == 1
    assert turns >= end.counts.steps > 3
    # one that takes longer than it may, or does not stick, is none
    assert not plain(construction.solve_cycle)(
        problem, EXACT, MEMORY, known, theta, 0.5 * (cycle.time - cycle.held), MOST
    )[0]
    assert plain(construction.solve_cycle)(
        problem, EXACT, MEMORY, known, theta, 1.01 * (cycle.time - cycle.held), MOST
    )[0]


def section_angle(problem, u):
    return plain(section.angle)(problem, *u)


@pytest.mark.parametrize("reach", [-0.1, 0.1])
@pytest.mark.parametrize("rtol", [1e-4, 1e-6])
def test_a_patch_stands_for_the_cycles_over_it(reach, rtol):
    """(M58): anywhere in it, its cycle is the one solved there, to some times the closing error."""
    problem, known, theta = problem_of("soft"), map_of(rtol), 1.2
    begun = State(taking_off(problem, theta).motion, MEMORY, Counts(7, 1, 20, 3, 0.5, 2))
    held = held_to(1e-3 * rtol)
    state = plain(construction.chart)(problem, held, begun, known, theta, reach, 1.0)
    assert known.sizes.tolist() == [1, 0, 0, 0, 0]
    start, per, n = known.patches[0]
    assert (start, per) == (theta, 2.0 / reach)
    assert 4 <= n <= 16
    assert known.width[0] == WIDEST
    assert not known.coefficients[0, int(n) :].any()
    assert state.motion == begun.motion
    assert state.counts[3:] == (3, 0.5, 2)
    assert state.counts.steps > 7 + 4 * n
    assert not state.memory.warm
    assert state.memory.plan != MEMORY.plan  # the last node's steps teach the next
    for part in (0.13, 0.5, 0.87):
        there = theta + part * reach
        row, x = plain(interpolant.locate)(known, there)
        assert (row, x) == (0, pytest.approx(2 * part - 1.0))
        cycle = plain(interpolant.cycle_from)(known, row, x)
        found, wanted, swing, *_ = plain(construction.solve_cycle)(
            problem, held, MEMORY, known, there, 1.0, MOST
        )
        assert found
        size = max(abs(wanted.turn), abs(swing))
        assert cycle.turn == pytest.approx(wanted.turn, abs=5 * known.closing * size)
        assert cycle.time == pytest.approx(wanted.time, rel=5 * known.closing)
        assert cycle.held == pytest.approx(wanted.held, rel=100 * known.closing)


def test_where_a_cycle_does_not_return_there_is_an_edge():
    """Its nodes were in vain, but the first is kept for the next attempt from the same angle."""
    problem, known = problem_of("soft"), map_of(1e-4)
    begun = taking_off(problem, 1.3)
    last = cycle_from(problem, known, 0.9)
    first = cycle_from(problem, known, 1.3)
    longest = 0.5 * (last.time - last.held + first.time - first.held)
    held = held_to(1e-7)
    chart = plain(construction.chart)
    chart(problem, held, begun, known, 1.3, -0.4, longest)
    assert known.sizes.tolist() == [0, 1, 0, 2, 0]
    assert known.edges[0] == pytest.approx(0.9)
    assert known.patches[0, 0] == 1.3
    assert known.width[0] == WIDEST
    before = known.coefficients[0, 0].copy()
    chart(problem, held, begun, known, 1.3, -0.1, longest)  # one node less
    n = int(known.patches[0, 2])
    assert known.sizes.tolist() == [1, 1, 0, 1, 0]
    assert known.coefficients[0, 0].tolist() == before.tolist()
    assert n > 3
    # where the first node does not return, nothing is kept
    nothing = map_of(1e-4)
    chart(problem, held, begun, nothing, 0.9, 0.4, longest)
    assert nothing.sizes.tolist() == [0, 1, 0, 1, 0]
    assert nothing.edges[0] == 0.9
    assert np.isnan(nothing.patches[0, 0])


def test_a_patch_that_costs_too_much_is_given_up_without_an_edge():
    """In the middle of a node too; what it has cost is known."""
    problem, known = problem_of("soft"), map_of(1e-4)
    begun = taking_off(problem, 1.2)
    first = plain(construction.solve_cycle)(problem, EXACT, MEMORY, map_of(1e-4), 1.2, 1.0, MOST)[4]
    known.balance[:] = first + 2, 7
    plain(construction.chart)(problem, EXACT, begun, known, 1.2, -0.1, 1.0)
    assert known.sizes.tolist() == [0, 0, 0, 2, 0]
    assert known.balance.tolist() == [-1, 7]
    assert known.width[0] == 0.5 * WIDEST
    # with as much as it takes, the rest is left
    enough = map_of(1e-4)
    enough.balance[0] = 10_000
    after = plain(construction.chart)(problem, EXACT, begun, enough, 1.2, -0.1, 1.0)
    assert enough.sizes[0] == 1
    assert 0 < enough.balance[0] <= 10_000 - after.counts.steps


def test_where_the_map_is_not_smooth_the_next_patch_is_half_as_wide():
    """Too noisy steps never close it: it is given up, at half of the nodes or all."""
    problem, known = problem_of("soft"), map_of(1e-13)
    begun, rough = taking_off(problem, 1.2), held_to(1e-2)
    plain(construction.chart)(problem, rough, begun, known, 1.2, -0.1, 1.0)
    assert known.width[0] == 0.5 * WIDEST
    assert known.sizes[:3].tolist() == [0, 0, 0]
    assert 12 < known.sizes[3] <= 24
    assert known.patches[0, 0] == 1.2


def test_nodes_for_the_motion_alone_follow_those_of_the_patch(monkeypatch):
    chart, known, begun = plain(construction.chart), map_of(1e-4, samples=True), []
    state, misses = taking_off(problem_of("soft"), 1.2), iter([1.0, 0.9])
    cycle = interpolant.Cycle(0.1, 1.0, 0.5)

    def resolve(*arguments):
        begun.append(arguments[4])
        return state.counts

    for name, found in (
        ("solve_cycle", lambda *_: (True, cycle, 0.2, state, 9)),
        ("added_node", lambda *_: next(misses) * CLOSED),
        ("add_motion", lambda *_: None),
        ("resolve_motion", resolve),
    ):
        monkeypatch.setitem(chart.__globals__, name, found)
    chart(problem_of("soft"), EXACT, state, known, 1.2, -0.1, 1.0)
    assert known.patches[0, 2] == 2  # nodes 0 and 1
    assert begun == [2]
    assert isinstance(begun[0], int)


def test_nodes_for_the_motion_end_as_it_is_known(monkeypatch):
    resolve, known, added = plain(construction.resolve_motion), map_of(1e-4, samples=True), []
    begun = taking_off(problem_of("soft"), 1.2)
    known.patches[0], known.inside.shapes[0] = (1.2, -20.0, 4), (2, 0, 1, 0)

    def add_node(*arguments):
        added.append(arguments[3])
        known.inside.shapes[0, 1] = 6 if len(added) == 2 else 0

    cycle = interpolant.Cycle(0.1, 1.0, 0.5)
    for name, found in (
        ("solve_cycle", lambda *_: (True, cycle, 0.2, begun, 9)),
        ("add_node", add_node),
        ("finish_motion", lambda *_: None),
    ):
        monkeypatch.setitem(resolve.__globals__, name, found)
    resolve(problem_of("soft"), EXACT, begun, known, 4, -0.1, 1.0)
    assert added == [4, 5]


def test_more_nodes_for_the_motion_end_where_one_does_not_return(monkeypatch):
    """It is not tried again: it would not return then either."""
    resolve, known, tried = plain(construction.resolve_motion), map_of(1e-4, samples=True), []
    begun = taking_off(problem_of("soft"), 1.2)
    known.patches[0], known.inside.shapes[0] = (1.2, -20.0, 4), (2, 0, 1, 0)

    def lost(*arguments):
        tried.append(arguments[4])
        return False, interpolant.Cycle(0.1, 1.0, 0.5), 0.2, begun, 9

    monkeypatch.setitem(resolve.__globals__, "solve_cycle", lost)
    resolve(problem_of("soft"), EXACT, begun, known, 4, -0.1, 1.0)
    assert tried == pytest.approx([1.2 - 0.05 * (interpolant.POINTS[4] + 1.0)])
    assert known.inside.shapes[0, 1] == 0  # no motion is known


CLOSED = 0.03 * 1e-4  # (M58) at a relative tolerance of 1e-4


@pytest.mark.parametrize(
    ("misses", "nodes"),
    [
        ([1.0, 5.0, 2.0, 0.5], 4),
        ([1e3, 0.5, 0.5], 3),  # the one before had missed by too much
        ([1e3, 11.0, 0.9, 9.0, 1.1, 0.99], 6),
        ([9.0, 0.9], 2),
        ([1e3] * 12 + [1e4], 0),  # the error should fall: it is given up at half of the nodes
        ([1e4] * 11 + [1e2] * 13, 0),
        ([1e4] * 12 + [1e2] * 10 + [9.0, 0.9], 24),
    ],
)
def test_when_a_patch_is_closed(misses, nodes, monkeypatch):
    """By a node missed by less than the closing error, the one before by less than ten times."""
    chart, known, seen = plain(construction.chart), map_of(1e-4), []
    begun, end = taking_off(problem_of("soft"), 1.2), taking_off(problem_of("soft"), 0.7)

    def solved(problem, accuracy, memory, known, theta, longest, most):
        seen.append(theta)
        return True, interpolant.Cycle(0.1, 1.0, 0.5), 0.2, end, 9

    left = iter(misses)
    monkeypatch.setitem(chart.__globals__, "solve_cycle", solved)
    monkeypatch.setitem(chart.__globals__, "added_node", lambda *_: next(left) * CLOSED)
    chart(problem_of("soft"), EXACT, begun, known, 1.2, -0.1, 1.0)
    assert seen == pytest.approx(1.2 - 0.05 * (interpolant.POINTS[: len(seen)] + 1.0))
    if nodes:
        assert known.patches[0] == pytest.approx([1.2, -20.0, nodes])
        assert len(seen) == nodes
        assert known.sizes.tolist() == [1, 0, 0, 0, 0]
        assert known.width[0] == WIDEST
    else:
        assert len(seen) == (13 if misses[0] == 1e3 else 24)
        assert known.sizes.tolist() == [0, 0, 0, len(seen), 0]
        assert known.width[0] == 0.5 * WIDEST
