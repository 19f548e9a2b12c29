"""Stick, take-off, slip and landing, one after the other."""

from math import inf, nan

import numpy as np
import pytest
from tests.entry import plain
from tests.systems import SLIDERS, Printed, motion_of, problem_of
from tests.unit.solver.exact.test_collocation import begin
from tests.unit.solver.exact.test_newton import SLIDES
from tests.unit.solver.exact.test_predictor import COLD
from tests.unit.solver.exact.test_step import held_to

import stiction as st
from stiction.solver import stick as sticking
from stiction.solver.exact import loop, pursuit, slip_frame
from stiction.solver.exact.record import Sink, record_of
from stiction.solver.state import (
    COMPLETED,
    NON_FINITE,
    NOTHING,
    RUNNING,
    STEP_UNDERFLOW,
    Counts,
    Motion,
    State,
)

MEMORY = COLD._replace(h=2e-5, plan=(1e-5, *[0.0] * 7), warm=True, place=4)
NEVER, NOWHERE = np.empty(0), np.empty((0, 7))


def no_samples(sticks):
    """Return where a run writes nothing but its sticks, and the next row of its samples."""
    return Sink(NEVER, NOWHERE, sticks, record_of(0)), 0


def at_rest_at(u, t=0.35):
    return State(Motion(t, *u, 0.0, 0.6, 0.8), MEMORY, Counts(5, 1, 20, 1, 0.5, 0))


def advance(name, state, t_end, budget=1000, accuracy=None, room=50):
    """Advance; return the code, the state, and the sticks."""
    sticks = np.zeros((room, 2))
    accuracy = accuracy or held_to(1e-4)
    problem = name if not isinstance(name, str) else problem_of(name)
    code, state, _, turns = plain(loop.take_steps)(
        problem, state, t_end, accuracy, budget, *no_samples(sticks)
    )
    return code, state, sticks[: state.counts.sticks], turns


@pytest.mark.parametrize("name", SLIDERS)
def test_a_stick_ends_where_friction_cannot_hold_any_more(name):
    """By (M5), and slip begins along (M18); the plan of the last take-off begins anew."""
    problem, u, t = problem_of(name), np.array([1e-4, 2e-6]), 0.35
    sticks, state = np.zeros((4, 2)), at_rest_at(u)
    duration, _ = plain(sticking.stick_duration)(problem, t, *u, inf)
    found = plain(loop.stick)(problem, state, inf, held_to(1e-4), *no_samples(sticks))
    ends, (motion, memory, counts), k = found
    assert (ends, k) == (True, 0)
    printed = Printed(problem, motion_of(*u, 1.0, 0.0, t))
    end = u + printed.drive("travel", t, duration)
    assert motion[:4] == pytest.approx((t + duration, *end, 0.0), rel=1e-12)
    a, e = printed.holding(t + duration, end), np.array(motion[4:])
    assert e @ e == pytest.approx(1.0, rel=1e-14)
    n = problem.surface
    normal = np.linalg.solve(np.array([[n.xx, n.xy], [n.xy, n.yy]]), a)
    assert e == pytest.approx(normal / np.hypot(*normal), abs=1e-7)
    assert memory == MEMORY._replace(h=1e-5, place=0, warm=False)
    assert counts == pytest.approx((5, 1, 20, 2, 0.5 + duration, 0))
    assert sticks[1] == pytest.approx([t, t + duration])
    # it does not end before the segment does
    stop = t + 0.5 * duration
    ends, (motion, _, counts), _ = plain(loop.stick)(
        problem, state, stop, held_to(1e-4), *no_samples(sticks)
    )
    assert (ends, motion.t, counts.stuck) == (False, stop, pytest.approx(0.5 + 0.5 * duration))
    # and goes on as the same stick in the next one
    begun = State(motion, memory, counts)
    ends, (motion, _, counts), _ = plain(loop.stick)(
        problem, begun, inf, held_to(1e-4), *no_samples(sticks)
    )
    assert (ends, counts.sticks) == (True, 2)
    assert sticks[1] == pytest.approx([t, t + duration], rel=1e-9)
    assert counts.stuck == pytest.approx(0.5 + duration)


def test_a_touch_is_no_stick():
    """(M10): if friction has less to spare than what the slip may be in error."""
    problem, u, t = problem_of("steady"), np.array([1e-4, 2e-6]), 0.35
    duration, _ = plain(sticking.stick_duration)(problem, t, *u, inf)
    spare = plain(sticking.to_spare)(problem, t, *u, duration)
    for part, number in ((0.99, 2), (1.01, 1)):
        sticks, held = np.zeros((4, 2)), held_to(1e-4)._replace(touch=part * spare)
        _, (motion, _, counts), _ = plain(loop.stick)(
            problem, at_rest_at(u), inf, held, *no_samples(sticks)
        )
        assert counts.sticks == number
        assert counts.stuck == pytest.approx(0.5 + (number - 1) * duration)
        assert motion.t == pytest.approx(t + duration)


@pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning")
def test_without_force_slip_starts_along_what_pulls_next():
    """K v_d, or as it was where nothing is driven."""
    bare = problem_of("steady")._replace(law=st.Coulomb(0.0))
    # a float of NumPy: 0/0 is to be no number, as in compiled code
    undamped = bare.system._replace(c_x=0.0, c_y=0.0, per_mass=np.float64(4.0))
    bare = bare._replace(system=undamped)
    sticks = np.zeros((4, 2))
    state = at_rest_at((0.0, 0.0))
    ends, (motion, *_), _ = plain(loop.stick)(bare, state, inf, held_to(1e-4), *no_samples(sticks))
    s = bare.system
    pull = np.array([s.k_x * s.cos_phi, s.k_y * s.sin_phi])
    assert ends
    assert motion[3:] == pytest.approx((0.0, *(pull / np.hypot(*pull))))
    still = bare._replace(drive=bare.drive._replace(velocity=0.0))
    _, (motion, *_), _ = plain(loop.stick)(still, state, inf, held_to(1e-4), *no_samples(sticks))
    assert motion[3:] == (0.0, 0.6, 0.8)


def test_sticks_are_recorded_or_made_longer():
    sticks = np.zeros((3, 2))
    counts = plain(loop.record_stick)(NOTHING, 1.0, 1.5, False, sticks)
    counts = plain(loop.record_stick)(counts, 2.0, 2.25, False, sticks)
    counts = plain(loop.record_stick)(counts, 2.25, 2.5, True, sticks)
    assert sticks.tolist() == [[1.0, 1.5], [2.0, 2.5], [0.0, 0.0]]
    assert counts == (0, 0, 0, 2, 1.0, 0)


@pytest.mark.parametrize(
    ("p", "wanted"),
    [((0.5, 0.4, 0.7), True), ((0.5, 0.7, 0.6), False), ((1.1, 0.4, 0.7), False)],
)
def test_a_slip_turns_up_inside_a_step(p, wanted):
    assert plain(loop.turns_up)(1.0, p) == wanted


def test_when_a_slip_is_zero():
    """Below 1e-13 tol sigma; on an ellipse below 1e-3 tol sigma where friction can hold."""
    accuracy = held_to(1e-4)
    tolerated, rest = 1e-4 * 1e-4, plain(loop.at_rest)
    held, pulled = (1e-5, 1e-7), (5e-3, 1e-5)
    for r, wanted in ((0.0, True), (0.9e-13, True), (1.1e-13, False), (1e-4, False)):
        motion = Motion(0.35, *held, r * tolerated, 1.0, 0.0)
        assert rest(problem_of("steady"), motion, accuracy) == wanted
    for r, u, wanted in (
        (0.9e-3, held, True),
        (1.1e-3, held, False),
        (0.9e-3, pulled, False),
        (0.0, pulled, True),
    ):
        motion = Motion(0.35, *u, r * tolerated, 1.0, 0.0)
        assert rest(problem_of("ellipse"), motion, accuracy) == wanted


def test_a_slip_that_is_faster_than_the_clock():
    """(M50a): it rests, if it is slowed by more than rounding, or has the speed that is zero."""
    problem, t, held = problem_of("steady"), 0.35, held_to(1e-4)
    frame = plain(slip_frame.frame_of)(problem, motion_of(5e-4, 1e-5, 9e-7, 4e-7))
    start = plain(slip_frame.outset)(problem, frame)
    for slows, r, wanted in (
        (0.5, 0.9e-13 * 0.5 * t, 0.0),
        (0.5, 1.1e-13 * 0.5 * t, 1.1e-13 * 0.5 * t),
        (1e-13, 1e-30, 1e-30),  # of a friction of 2: rounding
        (-0.5, 1e-30, 1e-30),
        (-0.5, 0.0, 1e-4 * 1e-4),
    ):
        forces = start._replace(f=2.0, a_1=2.0 - slows)
        slip = Motion(t, 5e-4, 1e-5, r, 0.6, 0.8)
        assert plain(loop.beyond_floats)(forces, slip, held) == slip._replace(r=wanted)


@pytest.mark.parametrize("name", SLIDERS)
def test_the_loop_ends_where_it_is_to_and_goes_on(name):
    """In one go, or with any budget; and says why it ends."""
    state = at_rest_at((1.9e-3, 1e-5))._replace(counts=NOTHING)
    code, end, sticks, turns = advance(name, state, 0.45)
    assert (code, end.motion.t) == (COMPLETED, 0.45)
    assert turns < 1000
    assert end.counts.sticks == len(sticks)
    assert end.counts.steps > 5
    paused, table = state, np.zeros((50, 2))
    for _ in range(1000):
        code, paused, _, used = plain(loop.take_steps)(
            problem_of(name), paused, 0.45, held_to(1e-4), 3, *no_samples(table)
        )
        assert used <= 3
        if code != RUNNING:
            break
    assert code == COMPLETED
    assert paused == end
    assert table[: len(sticks)].tolist() == sticks.tolist()
    assert advance(name, end, 0.45)[0] == COMPLETED
    assert advance(name, state, 0.45, room=0)[0] == RUNNING
    assert advance(name, state, 0.45, room=0)[1] == state
    wild = state._replace(motion=state.motion._replace(u_y=nan))
    assert advance(name, wild, 0.45)[0] == NON_FINITE
    wild = state._replace(motion=state.motion._replace(r=inf))
    assert advance(name, wild, 0.45)[0] == NON_FINITE
    wild = state._replace(motion=state.motion._replace(u_x=-inf))
    assert advance(name, wild, 0.45)[0] == NON_FINITE
    never = held_to(1e-4)._replace(newton=0.0)
    sliding = state._replace(motion=state.motion._replace(r=1e-2))
    assert advance(name, sliding, 0.45, accuracy=never)[0] == STEP_UNDERFLOW


def size_after(memory, t_stop):
    """Return the size of a step that is hardly wrong, and the size to try after it."""
    problem, frame, *_ = begin("steady", SLIDES[0], "not")
    start, motion = plain(slip_frame.outset)(problem, frame), motion_of(*SLIDES[0])
    memory = memory._replace(p=(motion.r,) * 4, w=(0.0,) * 4)
    state = State(motion, memory, NOTHING)
    done, state, _ = plain(loop.slip)(
        problem, frame, start, state, t_stop, held_to(1.0), *no_samples(np.zeros((0, 2)))
    )
    assert done
    return state.memory.h_last, state.memory.h


@pytest.mark.parametrize(("part", "after"), [(2.0, 2.0), (0.8, 1.6), (0.2, 0.4), (0.05, 1.0)])
def test_the_size_after_a_step_to_the_end_of_a_segment(part, after):
    """Twice its size, (M43); one so much shorter than the size to try says nothing of it."""
    taken, size = size_after(COLD._replace(h=1e-5), 0.35 + part * 1e-5)
    assert taken == pytest.approx(min(part, 1.0) * 1e-5, rel=1e-9)
    assert size == pytest.approx(after * 1e-5, rel=1e-9)


@pytest.mark.parametrize(
    ("warm", "part", "factor"),
    [(True, inf, 0.2), (True, 0.95, 0.2), (True, 0.8, 2.0), (False, inf, 2.0)],
)
def test_an_error_that_has_grown_will_grow_on(warm, part, factor):
    """(M43), from an error of nothing: least of all. Not after a first step, or one cut short."""
    memory = COLD._replace(h=1e-5, h_last=1e-5, ease=1e9, warm=warm)
    taken, size = size_after(memory, 0.35 + part * 1e-5)
    assert size == pytest.approx(factor * taken, rel=1e-9)


def test_a_landing_in_closed_form_takes_no_step():
    """(M50), however slow the slip is."""
    slow = motion_of(5e-4, 1e-5, 9e-13, 4e-13)
    _, state, _, turns = advance("steady", State(slow, MEMORY, NOTHING), 0.45, budget=1)
    assert turns == 1
    assert 0.35 < state.motion.t < 0.35 + 1e-11
    assert (state.motion.r, state.counts.steps) == (0.0, 0)


def test_a_landing_in_closed_form_and_its_samples():
    """(M49): the state at zero slip, and what is left of the slip at each time before."""
    problem = problem_of("steady")
    frame = plain(slip_frame.frame_of)(problem, motion_of(5e-4, 1e-5, 9e-7, 4e-7))
    start = plain(slip_frame.outset)(problem, frame)
    closed = plain(pursuit.pursuit)(problem, frame, start, held_to(1.0)._replace(speed=1.0))
    T, t = closed[0], frame.t
    times, samples = t + T * np.array([-1.0, 0.4, 0.6, 2.0]), np.zeros((4, 7))
    state = at_rest_at((0.0, 0.0))
    sink = Sink(times, samples, np.zeros((0, 2)), record_of(0))
    found, k = plain(pursuit.land)(problem, frame, start, state, closed, sink, 1)
    assert k == 3
    u = plain(slip_frame.elongation)(problem, frame, *closed)
    assert found.motion == pytest.approx((t + T, *u, 0.0, frame.e_x, frame.e_y))
    assert found.memory == MEMORY._replace(h=1e-5, place=0, warm=False)
    assert not samples[[0, 3]].any()
    for time, row in zip(times[1:3], samples[1:3], strict=True):
        before = plain(pursuit.slip_before_landing)
        speed, n_1, n_2 = before(frame.r, start.a_1, start.a_2, start.f, t + T - time)
        e = np.array([frame.e_x, frame.e_y]), np.array([-frame.e_y, frame.e_x])
        assert row[2:4] == pytest.approx(speed * (n_1 * e[0] + n_2 * e[1]), rel=1e-9)
        assert np.hypot(*row[4:6]) == pytest.approx(start.f * problem.system.mass)
        assert row[:2] == pytest.approx([frame.u_x, frame.u_y], rel=1e-2)
    # what is slipped between two samples is the integral of the slip, about linear in time
    driven = np.array([problem.system.cos_phi, problem.system.sin_phi]) * 2e-3
    gone = driven * np.diff(times[1:3]) - np.diff(samples[1:3, :2], axis=0)[0]
    wanted = 0.5 * (samples[1, 2:4] + samples[2, 2:4]) * np.diff(times[1:3])
    assert gone == pytest.approx(wanted, rel=1e-2)


def test_where_nothing_swings_a_step_follows_the_slow_motion():
    """The slip swings slowly, and turns with it; that is not taken for a swing of the stiff spring.

    A fast period takes 1 ms, a slow one 100 ms.
    """
    slider = st.presets.nakano_popov_2020().replace(phi="10 deg", drive=st.ConstantVelocity(0.01))
    short, long = (
        st.simulate(slider, duration, sample_rate=1.0, multiscale=False).statistics
        for duration in (0.5, 1.0)
    )
    assert long.stick_count == short.stick_count
    assert (
        long.steps - short.steps < 5 * 140
    )  # in 5 slow periods; 195 each without the drift of (M21)
    sharp = st.simulate(slider, 1.0, sample_rate=1e3, multiscale=False, rtol=1e-10)
    run = st.simulate(slider, 1.0, sample_rate=1e3, multiscale=False)
    for name, size in (("spring_x", 1e-4), ("spring_y", 2e-3)):
        assert np.abs(run.data[name] - sharp.data[name]).max() < size
