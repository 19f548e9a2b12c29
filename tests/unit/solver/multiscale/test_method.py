"""When the return map serves a run, and what its steps are held to."""

import numpy as np
import pytest
from tests.systems import problem_of as other_problem
from tests.unit.solver.exact.test_step import held_to
from tests.unit.solver.multiscale.test_construction import SOFT, problem_of, taking_off

import stiction as st
from stiction.solver.multiscale import method
from stiction.solver.multiscale.method import Multiscale
from stiction.solver.multiscale.return_map import CLOSING, STEP_SHARE
from stiction.solver.state import Output

HELD = held_to(1e-4)._replace(touch=0.3)


@pytest.fixture
def calls(monkeypatch):
    """Take the place of the loops; return the arguments of each call."""
    found = []

    def noted(function, *arguments):
        found.append((function, *arguments))
        return 0, arguments[1]

    monkeypatch.setattr(method, "advance_compiled", noted)
    monkeypatch.setattr("stiction.solver.exact.method.advance_compiled", noted)
    return found


def out():
    return Output(np.empty(0), np.empty((0, 7)), np.zeros((4, 2)))


def test_steps_are_finer_and_every_stick_counts(calls):
    solver, problem = Multiscale(SOFT, 1e-5), problem_of("soft")
    state = taking_off(problem, 1.0)
    assert solver.advance(problem, state, 2.0, HELD, 7, out()) == (0, state)
    ((function, seen, _, end, fine, budget, _, known),) = calls
    assert function is method.stride
    assert (end, budget) == (2.0, 7)
    assert seen == problem._replace(law=solver.law)
    assert fine == HELD._replace(
        tolerance=STEP_SHARE * HELD.tolerance,
        newton=STEP_SHARE * HELD.newton,
        least=HELD.least / STEP_SHARE,
        touch=0.0,
    )
    assert known.closing == CLOSING * 1e-5


def test_what_is_known_serves_the_same_problem_only(calls):
    solver, problem = Multiscale(SOFT, 1e-5), problem_of("soft")
    state, more = taking_off(problem, 1.0), problem._replace(bend=1.0)
    for each in (problem, problem, more, more):
        solver.advance(each, state, 2.0, HELD, 7, out())
    first, second, third, fourth = (call[-1] for call in calls)
    assert first is second
    assert third is fourth
    assert first is not third


def test_where_drive_or_load_vary_steps_are_taken(calls):
    solver, problem = Multiscale(SOFT, 1e-5), problem_of("soft")
    varying, state = other_problem("program"), taking_off(problem, 1.0)
    for each in (
        varying,
        varying._replace(drive=problem.drive),
        problem._replace(load=varying.load),
    ):
        calls.clear()
        solver.advance(each, state, 2.0, HELD, 7, out())
        ((function, _, _, _, held, *_),) = calls
        assert function is not method.stride
        assert held == HELD


def test_a_jump_ends_the_last_cycle():
    solver, problem = Multiscale(SOFT, 1e-5), problem_of("soft")
    state = taking_off(problem, 1.0)
    assert solver.enter_segment(state, 0.0, 0.0).motion == state.motion
    solver.known = method.empty_map(1e-5, 0)
    solver.known.last[:] = 0.3, 1.0
    found = solver.enter_segment(state, 1e-3, 0.0)
    assert np.isnan(solver.known.last).all()
    assert found.motion.r == pytest.approx(1e-3)


@pytest.mark.parametrize(
    ("times", "room"), [([], 0), ([0.5, 9.0], 0), ([0.5, 8.9], 1), ([0.6], 1), ([0.5, 1.0, 9.0], 1)]
)
def test_there_is_room_for_the_motion_if_there_are_samples(calls, times, room):
    """Between start and end of the run: these two are no samples inside a cycle."""
    solver, problem = Multiscale(SOFT, 1e-5), problem_of("soft")
    settings = st.Settings(duration=8.5, multiscale=True)
    state = solver.begin(st.Description(SOFT, st.Initial(time=0.5), settings))
    output = Output(np.array(times), np.empty((len(times), 7)), np.zeros((4, 2)))
    solver.advance(problem, state, 2.0, HELD, 7, output)
    assert bool(len(calls[0][-1].record.rows)) == bool(room)
