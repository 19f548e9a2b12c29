"""Samples of sticks and inside steps."""

from math import inf

import numpy as np
import pytest
from tests.entry import plain
from tests.systems import SLIDERS, Printed, motion_of, problem_of
from tests.unit.solver.exact.test_collocation import A, begin
from tests.unit.solver.exact.test_newton import SLIDES, held_to

from stiction.solver.exact import error_estimate, newton, oscillation, record, sampling, slip_frame
from stiction.solver.exact.collocation import SlipStep

ALL = pytest.mark.parametrize(("name", "drawn"), [(n, d) for n in SLIDERS for d in SLIDES])
EXACT = held_to(1e-13)._replace(speed=1e-6, square_x=1e-3, square_y=1e-3)


def step_of(name, drawn, size):
    """Return a step of slip, solved."""
    problem, frame, o, printed, h = begin(name, drawn, "not")
    h *= size / 0.02
    return problem, frame, o, printed, solve(problem, frame, o, h)


def solve(problem, frame, o, h):
    """Return a step."""
    guess = SlipStep(plain(oscillation.swing)(o, h, False), h, (frame.r,) * 3, (0.0,) * 3)
    converged, found, _ = plain(newton.solve)(problem, frame, o, guess, False, EXACT, 1.0)
    assert converged
    return found


@ALL
@pytest.mark.parametrize("size", [0.02, 0.035, 0.5])
@pytest.mark.parametrize("part", [0.05, 0.6, 1.0])
def test_a_value_inside_a_step_is_the_end_of_a_shorter_one(name, drawn, size, part):
    """Section 14 of the method, and (M30)."""
    problem, frame, o, printed, step = step_of(name, drawn, size)
    h = step.h
    dt = h if part == 1.0 else part * h
    shorter, _, q, turn = solve(problem, frame, o, dt)
    start = plain(slip_frame.outset)(problem, frame)
    motion, _ = plain(error_estimate.moving)(problem, frame, start, EXACT)
    found = plain(sampling.within)(problem, frame, start, step, dt, EXACT, motion)
    z_1 = dt * (A[2] @ q + shorter.slid[2])
    assert found == pytest.approx((z_1, dt * A[2] @ np.multiply(q, turn), q[2], turn[2]), rel=1e-9)
    # what the whole samples say
    times, samples = np.array([frame.t - 1.0, frame.t + dt, frame.t + 2 * h]), np.zeros((3, 7))
    sample = plain(sampling.sample_slip)
    k = sample(problem, frame, start, step, EXACT, times, samples, 1)
    assert k == 2
    assert not samples[[0, 2]].any()
    u = plain(slip_frame.elongation)(problem, frame, dt, *found[:2])
    e = np.array([1.0, turn[2]]) @ printed.axes
    n = problem.surface
    N = np.array([[n.xx, n.xy], [n.xy, n.yy]])
    f, _ = printed.friction(frame.t + dt, q[2] * np.hypot(*e))
    force = printed.m * f * N @ e / np.sqrt(e @ N @ e)
    assert samples[1] == pytest.approx([*u, *(q[2] * e), *force, 0.0], rel=1e-7)
    assert sample(problem, frame, start, step, EXACT, times, samples, 2) == 2
    assert sample(problem, frame, start, step, EXACT, times, samples, 3) == 3


@ALL
@pytest.mark.parametrize("size", [0.02, 0.035])
def test_where_that_is_accurate_enough_the_polynomial_is_taken(name, drawn, size):
    problem, frame, o, _, step = step_of(name, drawn, size)
    swing, h, p, w = step
    start, coarse = plain(slip_frame.outset)(problem, frame), EXACT._replace(inside=1e-6)
    arguments = problem, frame, start, step
    for part in (0.2, 0.7):
        found = plain(sampling.within)(*arguments, part * h, coarse, 1.0)
        rest, across = np.subtract(p, swing.p), np.multiply(p, w)
        swung = plain(oscillation.swings)(o, h)
        assert found == plain(record.on_polynomial)(frame.r, h, swung, o, rest, w, across, part * h)
        assert found == pytest.approx(
            plain(sampling.within)(*arguments, part * h, EXACT, 1.0), rel=1e-3, abs=1e-5
        )
        finer = EXACT._replace(inside=0.9e-6)
        assert plain(sampling.within)(*arguments, part * h, finer, 1.0) != found
    ends = plain(sampling.within)(*arguments, h, coarse, 1.0)
    assert ends == plain(sampling.within)(*arguments, h, EXACT, 1.0)


@ALL
def test_nothing_swings_in_a_part_of_a_step_longer_than_an_oscillation(name, drawn):
    """Section 14 of the method: the error of a step laid over it would not have been estimated."""
    problem, frame, o, _, _ = begin(name, drawn, "not")
    h = 1.4 * np.sqrt(oscillation.MOST_SQUARE / o.k)
    start, motion = plain(slip_frame.outset)(problem, frame), 1.0
    step = SlipStep(plain(oscillation.still)(), h, (frame.r,) * 3, (0.0,) * 3)
    assert not plain(oscillation.swings)(o, h)
    for part in (0.3, 0.6):  # of a step whose stages are any
        shorter = step._replace(h=part * h)
        converged, found, _ = plain(newton.solve)(problem, frame, o, shorter, False, EXACT, motion)
        if not (converged and min(found.p) > 0.0):
            continue
        value = plain(sampling.within)(problem, frame, start, step, part * h, EXACT, motion)
        assert value[2:] == pytest.approx((found.p[2], found.w[2]), rel=1e-9)


def test_where_a_shorter_step_is_not_found_the_cubic_is_taken():
    """And the slip is no less than zero."""
    problem, frame, _, _, step = step_of("steady", SLIDES[0], 0.02)
    h = step.h
    start, never = plain(slip_frame.outset)(problem, frame), EXACT._replace(newton=0.0)
    arguments = 0.5 * h, never, 1.0
    within = plain(sampling.within)
    found = within(problem, frame, start, step, *arguments)
    exact = within(problem, frame, start, step, 0.5 * h, EXACT, 1.0)
    assert found == pytest.approx(exact, rel=1e-3)
    assert found != exact
    falling = step._replace(p=tuple(-each for each in step.p))
    assert within(problem, frame, start, falling, *arguments)[2] == 0.0
    assert within(problem, frame, start, step, 0.0, EXACT, 1.0) == (0.0, 0.0, frame.r, 0.0)
    problem, frame, _, _, step = step_of("steady", SLIDES[0], 0.5)
    h = step.h
    start = plain(slip_frame.outset)(problem, frame)
    for dt in (0.5 * h, 0.05 * h):  # both over the oscillation, or the shorter one is not
        found = within(problem, frame, start, step, dt, never, 1.0)
        exact = within(problem, frame, start, step, dt, EXACT, 1.0)
        scale = exact[0], exact[0], exact[2], 1.0
        assert np.divide(found, scale) == pytest.approx(np.divide(exact, scale), abs=2e-2)


@pytest.mark.parametrize("name", SLIDERS)
@pytest.mark.parametrize("held", [True, False])
def test_samples_of_a_stick(name, held):
    """(M5), no slip, and the force that holds (M2); up to and with its end."""
    problem, t, u = problem_of(name), 0.35, np.array([1e-4, 2e-6])
    printed = Printed(problem, motion_of(*u, 1.0, 0.0, t))
    times, samples = np.array([0.1, 0.35, 0.36, 0.4, 0.41]), np.full((5, 7), np.nan)
    fill = plain(sampling.sample_stick)
    assert fill(problem, t, *u, 0.4, held, times, samples, 1) == 4
    assert np.isnan(samples[[0, 4]]).all()
    for time, row in zip(times[1:4], samples[1:4], strict=True):
        there = u + printed.drive("travel", t, time - t)
        force = printed.m * printed.holding(time, there)
        wanted = *there, 0.0, 0.0, *force, float(held)
        assert row == pytest.approx(wanted, rel=1e-12)
    assert fill(problem, t, *u, inf, held, times, samples, 4) == 5
