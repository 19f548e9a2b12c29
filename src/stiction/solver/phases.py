"""The two phases of the motion: a stick as a whole, and one step of slip."""

from __future__ import annotations

from math import sqrt

import numpy as np

from stiction.solver.blocks import Triple, dot
from stiction.solver.compiled import inlined
from stiction.solver.frame import Frame, Outset, elongation, turned
from stiction.solver.newton import products
from stiction.solver.problem import (
    Problem,
    at,
    coefficient,
    in_principal_axes,
    rate,
    travel,
)
from stiction.solver.radau import A, ease, step_factor
from stiction.solver.sampling import sample_slip, sample_stick
from stiction.solver.state import (
    PLANNED,
    Accuracy,
    Counts,
    Memory,
    Motion,
    State,
    at_takeoff,
    counted,
    planned,
    size_to_try,
)
from stiction.solver.step import step
from stiction.solver.stick import holding, stick_duration, to_spare
from stiction.solver.surface import takeoff

GROWTH = 2.0


@inlined
def stick(
    problem: Problem,
    state: State,
    t_stop: float,
    accuracy: Accuracy,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
    sticks: np.ndarray,
) -> tuple[bool, State, int]:
    """Hold zero slip as long as friction can, then turn the slip direction to take-off.

    A slip that only touches zero may be held for a moment by its error: that is no stick.
    Returns whether it takes off, the state, and the next row of the samples.
    """
    motion, memory, counts = state
    t, u_x, u_y = motion.t, motion.u_x, motion.u_y
    duration, ends = stick_duration(problem, t, u_x, u_y, t_stop)
    ends = ends and t + duration < t_stop
    end = t_stop if t + duration >= t_stop else t + duration
    if end > t:
        row = counts.sticks
        goes_on = row > 0 and sticks[row - 1, 1] == t  # the same stick, in another stretch
        touch = to_spare(problem, t, u_x, u_y, duration) < accuracy.touch
        held = goes_on or not touch
        k = sample_stick(problem, t, u_x, u_y, end, held, times, samples, k)
        d_x, d_y = in_principal_axes(problem, travel(problem.drive, t, end - t))
        u_x, u_y = u_x + d_x, u_y + d_y
        if held:
            counts = recorded(counts, t, end, goes_on, sticks)
    a_x, a_y = holding(problem, end, u_x, u_y)
    limit = coefficient(problem.law, 0.0) * at(problem.load, end) * problem.system.per_mass
    a_x, a_y = takeoff(problem, (a_x, a_y), limit)
    a = sqrt(a_x * a_x + a_y * a_y)
    if a == 0.0:  # nothing pulls yet, as at the start without friction: slip follows da/dt
        v_x, v_y = in_principal_axes(problem, rate(problem.drive, end))
        a_x, a_y = problem.system.k_x * v_x, problem.system.k_y * v_y
        a = sqrt(a_x * a_x + a_y * a_y)
    e_x, e_y = (a_x / a, a_y / a) if a > 0.0 else (motion.e_x, motion.e_y)
    motion = Motion(end, u_x, u_y, 0.0, e_x, e_y)
    return ends, State(motion, at_takeoff(memory), counts), k


@inlined
def recorded(counts: Counts, t: float, end: float, goes_on: bool, sticks: np.ndarray) -> Counts:
    """Write a stick interval, or make the last one longer; return the counts with it."""
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
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
) -> tuple[bool, State, int]:
    """Take one step of slip and plan the next."""
    motion, memory, counts = state
    t, r = motion.t, motion.r
    done, landing, swing, h, p, w, error, rejected, iterations = step(
        problem, frame, start, t_stop, memory, accuracy
    )
    counts = counted(counts, rejected, iterations)
    if not done:
        return False, State(motion, memory, counts), k
    k = sample_slip(problem, frame, start, swing, h, p, w, accuracy, times, samples, k)
    slid_1, slid_2 = h * (dot(A[2], p) + swing.slid[2]), h * dot(A[2], products(p, w))
    u_x, u_y = elongation(problem, frame, h, slid_1, slid_2)
    e_x, e_y = turned(frame, w[2])
    at_ease = ease(error)
    factor = step_factor(error, GROWTH)
    end = t_stop if t + h >= t_stop else t + h
    plan = memory.plan
    if memory.place < PLANNED and end < t_stop:
        plan = planned(plan, memory.place, h * step_factor(error, 4.0))
    # Gustafsson's predictive control (M43): errors that grow grow on; not if the step was cut, as
    # before a landing, which it would put off for ever
    if r > 0.0 and memory.warm and h > 0.9 * size_to_try(memory):
        trend = 0.9 * h / memory.h_last * at_ease * at_ease / memory.ease
        factor = min(factor, max(0.2, trend))
    memory = Memory(
        h * factor if h > 0.1 * memory.h or end < t_stop else memory.h,
        plan,
        1 if turns_up(r, p) else memory.place + 1,
        h,
        min(at_ease, 3.0),
        not landing,
        (r, p[0], p[1], p[2]),
        (0.0, w[0], w[1], w[2]),
    )
    r = 0.0 if landing else p[2] * sqrt(1.0 + w[2] * w[2])
    return True, State(Motion(end, u_x, u_y, r, e_x, e_y), memory, counts), k


@inlined
def turns_up(r: float, p: Triple) -> bool:
    """Return whether the slip falls and rises again in a step: a swing ends, another begins."""
    return p[0] < r and p[1] < p[2]
