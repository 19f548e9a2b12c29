"""Samples inside a step: each is the end of a shorter step."""

from math import inf

import numpy as np
import pytest
from tests.entry import plain
from tests.unit.solver.smooth.systems import (
    EXACT,
    LAWS,
    TIME,
    A,
    Equations,
    begun,
)
from tests.unit.solver.smooth.test_error_estimate import polynomials, solved_step

from stiction.solver.exact.sampling import COLUMNS
from stiction.solver.smooth import error_estimate, newton, sampling
from stiction.solver.smooth.workspace import INSIDE, LAST, START, workspace


def end_at(name, h, drive):
    """Return the slip velocities at the stages of a step by itself, and its states at the end."""
    _, _, w = solved_step(name, h, drive)
    return w.values[1:4, :2], w.values[LAST, 2:]


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("drive", ["steady", "spring"])
def test_samples_inside_a_step(name, drive):
    """Position, slip velocity, friction, no stick, and the states; of what lies in the step."""
    h, parts = 5e-4, np.array([-0.1, 0.0, 0.3, 0.9, 1.0, 1.2])
    problem, start, w = solved_step(name, h, drive)
    error = plain(error_estimate.local_error)(problem, start, h, w, EXACT)
    assert error < inf
    printed, n = Equations(name, drive), len(w.size) - 2
    times, samples = TIME + parts * h, np.full((6, COLUMNS + n), np.nan)
    times[4] = start.t + h
    inner = plain(workspace)(n)
    k = plain(sampling.sample)(problem, start, h, w, inner, EXACT, times, samples, 1)
    assert k == 5
    assert np.isnan(samples[[0, 5]]).all()
    assert not np.isnan(samples[1:5]).any()
    for time, row in zip(times[1:5], samples[1:5], strict=True):
        dt, s, z, slid = time - TIME, printed.s, printed.z, np.zeros(2)
        if dt > 0.0:
            stages, z = end_at(name, dt, drive)
            s, slid = stages[2], dt * A[2] @ stages
        u = printed.u + printed.printed.drive("travel", TIME, dt) - slid
        force = printed.m * printed.friction(dt, s, z)
        wanted = np.array([*u, *s, *force, 0.0, *z])
        assert row == pytest.approx(wanted, rel=1e-7, abs=1e-12)
    assert plain(sampling.sample)(problem, start, h, w, inner, EXACT, times, samples, 5) == 5
    assert plain(sampling.sample)(problem, start, h, w, inner, EXACT, times, samples, 6) == 6


@pytest.mark.parametrize("name", LAWS)
def test_where_a_shorter_step_is_not_found_the_polynomial_is_balanced(name, monkeypatch):
    """The cubic less its error, by (M70) with gamma = c; almost as exact."""
    h, x = 1e-4, 0.7
    problem, start, w = solved_step(name, h, "steady")
    plain(error_estimate.local_error)(problem, start, h, w, EXACT)
    printed, n = Equations(name, "steady"), len(w.size) - 2
    times, samples = np.array([TIME + x * h]), np.full((1, COLUMNS + n), np.nan)
    rough = EXACT._replace(newton=1e-20)  # which no balance reaches, but it is tried
    inner = plain(workspace)(n)

    fill = plain(sampling.sample)
    monkeypatch.setitem(fill.__globals__, "shorter", lambda *_: False)
    assert fill(problem, start, h, w, inner, rough, times, samples, 0) == 1
    *_, slid = polynomials(w, x)
    (row,) = samples
    u = printed.u + printed.printed.drive("travel", TIME, x * h) - h * slid
    assert row[:2] == pytest.approx(u, rel=1e-12)
    stages, z = end_at(name, x * h, "steady")
    sizes = np.array([1.0, 1.0, *w.size[2:]])
    exact, found = np.array([*stages[2], *z]), np.array([*row[2:4], *row[COLUMNS:]])
    assert found / sizes == pytest.approx(exact / sizes, rel=1e-3)
    force = printed.m * printed.friction(x * h, found[:2], found[2:])
    assert row[4:7] == pytest.approx([*force, 0.0])


@pytest.mark.parametrize("name", ["smoothed", "lugre", "ageing"])
def test_a_shorter_step_is_solved_by_itself(name):
    """Into the other workspace, with the sizes of the whole step."""
    h, x = 5e-4, 0.4
    problem, start, w = solved_step(name, h)
    w.size[:2] = 0.3, 0.4
    before = w.values.copy()
    inner = plain(workspace)(len(w.size) - 2)
    assert plain(sampling.shorter)(problem, start, x, h, w, inner, EXACT)
    assert (w.values[:4] == before[:4]).all()
    assert inner.size.tolist() == w.size.tolist()
    assert inner.values[START].tolist() == w.values[START].tolist()
    _, _, wanted = solved_step(name, x * h)
    assert inner.values[1:4] == pytest.approx(wanted.values[1:4], rel=1e-9)
    never = EXACT._replace(newton=-1.0)
    w.values[2, 0] = np.nan
    assert not plain(sampling.shorter)(problem, start, x, h, w, inner, never)


def test_first_guesses_are_the_polynomial_of_the_whole(monkeypatch):
    """So that one or two iterations suffice."""
    problem, start, w = solved_step("lugre", 5e-4)
    inner, iterations = plain(workspace)(2), []

    shorter = plain(sampling.shorter)
    solve = shorter.__globals__["solve"]

    def counted(*arguments):
        found = solve(*arguments)
        iterations.append(found[1])
        return found

    monkeypatch.setitem(shorter.__globals__, "solve", counted)
    assert shorter(problem, start, 0.6, 5e-4, w, inner, EXACT._replace(newton=1e-8))
    cold = begun("lugre")[2]
    cold.values[1:4] = cold.values[START]
    _, _, _, (q_x, q_y) = begun("lugre")
    *_, alone = plain(newton.solve)(
        problem, start, 3e-4, (q_x,) * 3, (q_y,) * 3, cold, EXACT._replace(newton=1e-8)
    )
    assert iterations[0] < alone
    assert not inner.values[INSIDE].any()
