"""The loop: stick, take off, slip, land, until the time or the step budget is used up."""

from __future__ import annotations

from math import isfinite, sqrt

import numpy as np

from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import compiled, inlined
from stiction.solver.exact.pursuit import INSTANT, land, pursuit
from stiction.solver.exact.record import Sink, StepRecord, keep_step
from stiction.solver.exact.sampling import end_of_step, sample_slip, sample_stick
from stiction.solver.exact.slip_frame import (
    Frame,
    Outset,
    elongation,
    frame_of,
    outset,
    turned_direction,
)
from stiction.solver.exact.step import step
from stiction.solver.problem import (
    Problem,
    at,
    coefficient,
    drive_rate,
    drive_travel,
    isotropic,
    smooth_until,
)
from stiction.solver.state import (
    ASKS,
    COMPLETED,
    NON_FINITE,
    PLANNED,
    RUNNING,
    STEP_UNDERFLOW,
    Counts,
    Memory,
    Motion,
    Plain,
    State,
    after_cut,
    at_takeoff,
    count_step,
    plain,
    size_to_try,
    write_plan,
)
from stiction.solver.stepping.block_algebra import Triple
from stiction.solver.stepping.control import CALMEST, GROWTH, ease, step_factor, trend
from stiction.solver.stepping.limit import ASKED, elsewhere
from stiction.solver.stick import holding, holds_on, margin, stick_duration, to_spare
from stiction.solver.surface import takeoff

NOT_CUT = 0.9  # of the size to try: a shorter step was cut or refused, which is not a trend
REMNANT = 0.1  # of the size: a step that the end of a segment cuts to less says nothing of the next
PLAN_GROWTH = 4.0  # of the sizes in the plan, at most
AT_REST, AT_REST_ON_ELLIPSE = 1e-13, 1e-3  # of the tolerated slip speed


@inlined
def stick(
    problem: Problem,
    state: State,
    t_stop: float,
    accuracy: Accuracy,
    sink: Sink,
    k: int,
) -> tuple[bool, State, int]:
    """Keep zero slip as long as friction can hold it, then set the direction of take-off.

    A slip that only touches zero may stick for a moment because of its error; that is not counted.
    Returns whether it takes off, the state, and the next row of the samples.
    """
    motion, memory, counts = state
    t, u_x, u_y = motion.t, motion.u_x, motion.u_y
    duration, ends = stick_duration(problem, t, u_x, u_y, t_stop)
    end = t_stop if t + duration >= t_stop else t + duration
    ends = ends and end < t_stop
    if ends:
        d_x, d_y = drive_travel(problem, t, end - t)
        smooth = smooth_until(problem.bend, end, t_stop)
        if holds_on(problem, end, u_x + d_x, u_y + d_y, smooth):
            ends, end = False, smooth
    if end > t:
        row = counts.sticks
        goes_on = row > 0 and sink.sticks[row - 1, 1] == t  # a stick continued over segments
        touch = to_spare(problem, t, u_x, u_y, duration) < accuracy.touch
        is_stick = goes_on or not touch
        k = sample_stick(problem, t, u_x, u_y, end, is_stick, sink.times, sink.samples, k)
        d_x, d_y = drive_travel(problem, t, end - t)
        u_x, u_y = u_x + d_x, u_y + d_y
        if is_stick:
            counts = record_stick(counts, t, end, goes_on, sink.sticks)
    a_x, a_y = holding(problem, end, u_x, u_y)
    limit = coefficient(problem.law, 0.0) * at(problem.load, end) * problem.system.per_mass
    a_x, a_y = takeoff(problem, (a_x, a_y), limit)
    a = sqrt(a_x * a_x + a_y * a_y)
    if a == 0.0:  # no force yet, as at a start without friction: slip follows da/dt
        v_x, v_y = drive_rate(problem, end)
        a_x, a_y = problem.system.k_x * v_x, problem.system.k_y * v_y
        a = sqrt(a_x * a_x + a_y * a_y)
    e_x, e_y = (a_x / a, a_y / a) if a > 0.0 else (motion.e_x, motion.e_y)
    motion = Motion(end, u_x, u_y, 0.0, e_x, e_y)
    return ends, State(motion, at_takeoff(memory), counts), k


@inlined
def record_stick(counts: Counts, t: float, end: float, goes_on: bool, sticks: np.ndarray) -> Counts:
    """Write a stick interval, or extend the last one; return the updated counts."""
    row = counts.sticks
    if goes_on:
        row -= 1
    else:
        sticks[row, 0] = t
    sticks[row, 1] = end
    stuck = counts.stuck + (end - t)
    return Counts(counts.steps, counts.rejected, counts.iterations, row + 1, stuck, counts.mapped)


@inlined
def slip(
    problem: Problem,
    frame: Frame,
    start: Outset,
    state: State,
    t_stop: float,
    accuracy: Accuracy,
    sink: Sink,
    k: int,
) -> tuple[bool, State, int]:
    """Take one step of slip and plan the next."""
    motion, memory, counts = state
    t, r = motion.t, motion.r
    done, landing, taken, error, limit, rejected, iterations = step(
        problem, frame, start, t_stop, memory, accuracy
    )
    counts = count_step(counts, rejected, iterations)
    if not done:
        return False, State(motion, memory, counts), k
    k = sample_slip(problem, frame, start, taken, accuracy, sink.times, sink.samples, k)
    keep_step(sink.record, frame, start, taken)
    _, h, p, w = taken
    slid_1, slid_2, _, _ = end_of_step(taken)
    u_x, u_y = elongation(problem, frame, h, slid_1, slid_2)
    e_x, e_y = turned_direction(frame, w[2])
    at_ease = ease(error)
    factor = step_factor(error, GROWTH)
    end = t_stop if t + h >= t_stop else t + h
    plan = memory.plan
    if memory.place < PLANNED and end < t_stop:
        plan = write_plan(plan, memory.place, h * step_factor(error, PLAN_GROWTH))
    # Gustafsson's predictive control (M43): a growing error is expected to grow on; not after a cut
    # step, as before a landing, which it would postpone for ever
    if r > 0.0 and memory.warm and h > NOT_CUT * size_to_try(memory):
        factor = min(factor, trend(h, memory.h_last, at_ease, memory.ease))
    memory = Memory(
        h * factor if h > REMNANT * memory.h or end < t_stop else memory.h,
        plan,
        1 if turns_up(r, p) else memory.place + 1,
        h,
        min(at_ease, CALMEST),
        not landing,
        (r, p[0], p[1], p[2]),
        (0.0, w[0], w[1], w[2]),
        elsewhere(limit) if landing else limit,
    )
    r = 0.0 if landing else p[2] * sqrt(1.0 + w[2] * w[2])
    return True, State(Motion(end, u_x, u_y, r, e_x, e_y), memory, counts), k


@inlined
def turns_up(r: float, p: Triple) -> bool:
    """Return whether the slip has a minimum in a step, between two swings."""
    return p[0] < r and p[1] < p[2]


@inlined
def at_rest(problem: Problem, motion: Motion, accuracy: Accuracy) -> bool:
    """Return whether the slip is zero for all practical purposes.

    On an elliptic surface there is no closed form for the end of a slip, and its direction keeps
    turning as it vanishes. There a slip that friction is about to end is cut off earlier.
    """
    tolerated = accuracy.tolerance * accuracy.speed
    if motion.r < AT_REST * tolerated:
        return True
    if isotropic(problem.surface) or motion.r > AT_REST_ON_ELLIPSE * tolerated:
        return False
    return margin(problem, motion.t, motion.u_x, motion.u_y)[0] < 0.0


@inlined
def beyond_floats(start: Outset, motion: Motion, accuracy: Accuracy) -> Motion:
    """Return a slip that changes faster than the clock goes as it is an instant later (M50a).

    Slip that friction and springs end, or turn back, within an instant is at rest, if they slow it
    by more than the rounding of forces. One that takes off, and that friction weakens faster, has
    the speed that counts as zero. All other slip stays as it is.
    """
    t, u_x, u_y, r, e_x, e_y = motion
    slows = start.f - start.a_1
    if r == 0.0:
        r = accuracy.tolerance * accuracy.speed
    elif slows > INSTANT * start.f and r < slows * INSTANT * abs(t):
        r = 0.0
    return Motion(t, u_x, u_y, r, e_x, e_y)


@inlined
def take_steps(
    problem: Problem,
    state: State,
    t_end: float,
    accuracy: Accuracy,
    budget: int,
    sink: Sink,
    k: int,
) -> tuple[int, State, int, int]:
    """Advance until `t_end`, until the budget of steps is used up, or no more sticks fit in.

    Parameters
    ----------
    problem, state
        The system, and its state.
    t_end : float
        s.
    accuracy : Accuracy
        The tolerances of each step.
    budget : int
        Steps to take at most.
    sink : Sink
        To be filled; sticks from ``state.counts.sticks`` on.
    k : int
        The next sample to fill.

    Returns
    -------
    code, state, k, turns
        `turns` is the number of turns of the loop, at most `budget`.
    """
    for turn in range(budget):
        motion = state.motion
        t = motion.t
        if t >= t_end:
            return COMPLETED, state, k, turn
        if not (isfinite(motion.u_x) and isfinite(motion.u_y) and isfinite(motion.r)):
            return NON_FINITE, state, k, turn
        if at_rest(problem, motion, accuracy):
            if state.counts.sticks >= len(sink.sticks):
                return RUNNING, state, k, turn
            motion = Motion(t, motion.u_x, motion.u_y, 0.0, motion.e_x, motion.e_y)
            state = State(motion, state.memory, state.counts)
            ends, state, k = stick(problem, state, t_end, accuracy, sink, k)
            motion = state.motion
            if not ends:
                continue
        if state.memory.limit[0] == ASKED:
            return ASKS, state, k, turn
        frame = frame_of(problem, motion)
        start = outset(problem, frame)
        smooth = smooth_until(problem.bend, motion.t, t_end)
        if motion.r > 0.0:
            closed = pursuit(problem, frame, start, accuracy)
            if t + closed[0] < smooth:
                state, k = land(problem, frame, start, state, closed, sink, k)
                continue
        done, state, k = slip(problem, frame, start, state, smooth, accuracy, sink, k)
        if not done:
            r = motion.r
            motion = beyond_floats(start, motion, accuracy)
            if motion.r == r:
                return STEP_UNDERFLOW, state, k, turn
            state = State(motion, at_takeoff(state.memory), state.counts)
            continue
        if smooth < t_end and state.motion.t >= smooth:
            state = State(state.motion, after_cut(state.memory), state.counts)
    code = COMPLETED if state.motion.t >= t_end else RUNNING
    return code, state, k, budget


@compiled
def advance(
    problem: Problem,
    state: State,
    t_end: float,
    accuracy: Accuracy,
    budget: int,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
    sticks: np.ndarray,
    record: StepRecord,
) -> tuple[int, Plain, int, int]:
    """Do as `take_steps`, and return the state as plain tuples for Python."""
    sink = Sink(times, samples, sticks, record)
    code, state, k, turns = take_steps(problem, state, t_end, accuracy, budget, sink, k)
    return code, plain(state), k, turns
