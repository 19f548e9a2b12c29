"""Samples of cycles that the return map has found."""

import numpy as np
import pytest
from tests.entry import map_of, plain
from tests.unit.solver.multiscale.test_construction import (
    EXACT,
    MEMORY,
    cycle_from,
    problem_of,
    taking_off,
)

from stiction.solver.exact import loop
from stiction.solver.exact.record import Sink, record_of
from stiction.solver.multiscale import history, replay
from stiction.solver.multiscale.return_map import NEAR, Stick
from stiction.solver.state import COMPLETED, NON_FINITE, RUNNING, Counts, State

COUNTS = Counts(7, 1, 20, 3, 0.5, 2)
T, THETA = 4.0, 1.1


@pytest.mark.parametrize("name", ["soft", "damped"])
def test_samples_of_a_cycle(name):
    """They are those of steps from the same take-off; the state itself stays as it was."""
    problem, known = problem_of(name), map_of(1e-6)
    cycle = cycle_from(problem, known, THETA)
    stick = Stick(T - 2e-3, T, THETA)
    landing = T + cycle.time - cycle.held
    parts = np.array([-1e-3, 0.0, *np.linspace(0.1, 0.97, 5) * (landing - T)])
    times = np.array([T - 3e-3, *(T + parts), landing + 1e-4])
    samples, state = np.full((len(times), 7), np.nan), taking_off(problem, 0.3, 1.0)
    state = State(state.motion, state.memory, COUNTS)
    code, found, k = plain(replay.sample_cycle)(
        problem, state, stick, landing, EXACT, times, samples, 1, known
    )
    assert (code <= COMPLETED, k) == (True, len(times) - 1)
    assert found.motion == state.motion
    assert found.memory == state.memory
    assert found.counts[3:] == COUNTS[3:]
    assert found.counts.steps > COUNTS.steps + 3
    assert np.isnan(samples[[0, -1]]).all()
    wanted = np.full((7, 7), np.nan)
    plain(loop.take_steps)(
        problem, taking_off(problem, THETA, T), landing, EXACT, 10**6,
        Sink(times[2:-1], wanted, np.zeros((2, 2)), record_of(0)), 0,
    )  # fmt: skip
    assert samples[3:-1, :6] == pytest.approx(wanted[1:6, :6], rel=1e-6, abs=1e-9)
    assert samples[1:-1, 6].tolist() == [1.0, 1.0, *[0.0] * 5]
    v = problem.drive.velocity * np.array([problem.system.cos_phi, problem.system.sin_phi])
    u = np.array(taking_off(problem, THETA).motion[1:3])
    assert samples[1, :4] == pytest.approx([*(u - 1e-3 * v), 0.0, 0.0])
    assert samples[2, :4] == pytest.approx([*u, 0.0, 0.0])


@pytest.mark.parametrize("after", [None, 1e-4])
def test_without_samples_of_the_slip_no_steps_are_taken(after):
    problem, known = problem_of("soft"), map_of(1e-6)
    stick, landing = Stick(T - 2e-3, T, THETA), T + 0.01
    times = np.array([T - 1e-3] if after is None else [T - 1e-3, landing + after])
    samples, state = np.full((2, 7), np.nan), State(taking_off(problem, 0.3).motion, MEMORY, COUNTS)
    code, found, k = plain(replay.sample_cycle)(
        problem, state, stick, landing, EXACT, times, samples, 0, known
    )
    assert (code, found, k) == (COMPLETED, state, 1)
    assert samples[0, 6] == 1.0
    assert np.isnan(samples[1]).all()


@pytest.mark.parametrize("longer", [1.0, 1.02])
def test_samples_of_a_cycle_like_another(longer):
    """They are its samples at the same share of the slip's duration, and those of the stick."""
    problem, known = problem_of("soft"), map_of(1e-6, samples=True)
    cycle = cycle_from(problem, known, THETA)
    plain(history.remember)(known, THETA, cycle)
    slip, parts = cycle.time - cycle.held, np.linspace(0.1, 0.97, 5)
    landing = T + longer * slip
    times = np.array([T - 1e-3, *(T + parts * longer * slip), landing + 1e-4])
    samples = np.full((7, 7), np.nan)
    k = plain(replay.sample_remembered)(
        problem, known, 0, Stick(T - 2e-3, T, THETA), landing, times, samples, 0
    )
    assert (k, samples[0, 6]) == (6, 1.0)
    assert np.isnan(samples[6]).all()
    wanted = np.full((5, 7), np.nan)
    plain(loop.take_steps)(
        problem, taking_off(problem, THETA, T), T + slip, EXACT, 10**6,
        Sink(T + parts * slip, wanted, np.zeros((2, 2)), record_of(0)), 0,
    )  # fmt: skip
    assert samples[1:6] == pytest.approx(wanted, rel=1e-4, abs=1e-7)


@pytest.mark.parametrize(("code", "calls"), [(RUNNING, 3), (NON_FINITE, 1)])
def test_steps_are_taken_until_the_samples_are_filled(code, calls, monkeypatch):
    """Not until the landing, nor where they fail; it may stick for a moment in between."""
    problem, known = problem_of("soft"), map_of(1e-6)
    stick, times = Stick(T - 2e-3, T, THETA), T + 1e-3 * np.arange(1, 4)
    state, seen = State(taking_off(problem, 0.3).motion, MEMORY, COUNTS), []

    def take_steps(_, state, *arguments):
        k = arguments[-3]
        seen.append(k)
        return code, state._replace(motion=state.motion._replace(t=times[k])), k + 1, 1

    cycle = plain(replay.sample_cycle)
    monkeypatch.setitem(cycle.__globals__, "take_steps", take_steps)
    samples = np.full((3, 7), np.nan)
    found, _, k = cycle(problem, state, stick, T + 0.01, EXACT, times, samples, 0, known)
    assert (found, k) == (code, calls)
    assert seen == list(range(calls))


def test_which_remembered_cycle_tells_the_motion_of_another():
    """One whose steps are kept, from an angle that differs by a patch's error at most."""
    known, alike = map_of(1e-6, samples=True), plain(replay.alike)
    known.past[:2, 0], known.inside.spans[:2] = THETA, [[0, 3], [3, 0]]
    assert alike(known, 0, THETA)
    for way in (1.0, -1.0):
        assert alike(known, 0, THETA + 0.9 * way * NEAR * known.closing)
        assert not alike(known, 0, THETA + 1.1 * way * NEAR * known.closing)
    assert not alike(known, 1, THETA)
    assert not alike(known, -1, THETA)
