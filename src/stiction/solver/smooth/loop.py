"""The loop of smooth steps, until the time or the step budget is used up."""

from __future__ import annotations

from math import hypot, inf, isfinite
from typing import NamedTuple

import numpy as np

from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import compiled, inlined, piece
from stiction.solver.problem import Problem, drive_travel, smooth_until, varies
from stiction.solver.smooth.coordinate import coordinate
from stiction.solver.smooth.dispatch import grain_of
from stiction.solver.smooth.right_hand_side import (
    Point,
    SmoothOutset,
    evaluate,
    keep_slopes,
    measure,
    moving,
    pull,
)
from stiction.solver.smooth.sampling import sample
from stiction.solver.smooth.state import (
    Numbers,
    SmoothMotion,
    SmoothState,
    with_limit,
    with_numbers,
)
from stiction.solver.smooth.step import remember, step
from stiction.solver.smooth.workspace import LAST, START, Workspace
from stiction.solver.state import (
    ASKS,
    COMPLETED,
    CUT,
    NON_FINITE,
    RUNNING,
    STEP_UNDERFLOW,
    count_step,
)
from stiction.solver.stepping.amplification import grows, write_rates
from stiction.solver.stepping.block_algebra import dot
from stiction.solver.stepping.control import CALMEST, GROWTH, ease, step_factor, trend
from stiction.solver.stepping.limit import (
    ASKED,
    NEAR_STEADY,
    Time,
    known_up_to,
    limit_there,
    within_limit,
)
from stiction.solver.stepping.radau import A

EAGER = 0.1  # of the growth that the error allows: the first size tried knows nothing of friction
COARSEST = 1e12  # of the slip speed that is resolved: a slip coordinate that is linear in effect


class Begun(NamedTuple):
    """The start of a step: slip coordinate, friction, slip speed, and the scales by `moving`."""

    start: SmoothOutset
    q_x: float
    q_y: float
    at: Point
    slip: float
    moved: float
    apart: float


@inlined
def begin(
    problem: Problem, motion: SmoothMotion, z: np.ndarray, w: Workspace, accuracy: Accuracy
) -> Begun:
    """Write the first row of a step, and begin it."""
    t, u_x, u_y, s_x, s_y = motion
    speed = accuracy.speed
    w.values[START, 0], w.values[START, 1] = s_x, s_y
    for k in range(len(z)):
        w.values[START, 2 + k] = z[k]
        w.size[2 + k] = 1.0
    grain = grain_of(problem.law, w.values, START)
    w.size[0] = w.size[1] = min(grain, speed)
    eps = grain if len(z) > 0 and grain < COARSEST * speed else inf
    bend = 0.0 if len(z) > 0 else min(grain, speed)
    unit = bend if eps == inf else min(1.0, speed / eps)
    q_x, q_y = coordinate(eps, s_x, s_y)
    start = SmoothOutset(t, u_x, u_y, eps, unit, 1.0)
    acting = pull(problem, start, 0.0)
    at = evaluate(problem, eps, acting.load, q_x, q_y, w, START, len(z) > 0)
    measure(problem, acting.load, w)
    moved, apart = moving(problem, t, acting, at, accuracy)
    slip = hypot(s_x, s_y)
    share = min(1.0, moved / (speed + slip))
    start = SmoothOutset(t, u_x, u_y, eps, unit, share)
    return Begun(start, q_x, q_y, at, slip, moved, apart)


@inlined
def motion_at_end(
    problem: Problem, start: SmoothOutset, h: float, end: float, w: Workspace
) -> SmoothMotion:
    """Return the motion at the end of a step."""
    d_x, d_y = drive_travel(problem, start.t, h)
    v = w.values
    slid_x = h * dot(A[2], (v[1, 0], v[2, 0], v[3, 0]))
    slid_y = h * dot(A[2], (v[1, 1], v[2, 1], v[3, 1]))
    u_x, u_y = start.u_x + (d_x - slid_x), start.u_y + (d_y - slid_y)
    return SmoothMotion(end, u_x, u_y, v[LAST, 0], v[LAST, 1])


@inlined
def steady(w: Workspace, left: float) -> bool:
    """Return whether the states at a step's start are nearly those of steady sliding.

    They would change by less than a hundredth of their scale until they forget, or until the end.
    """
    for k in range(2, w.size.shape[0]):
        forgotten = abs(w.jacobian[START, k, k]) + 1.0 / left
        if not abs(w.changes[START, k]) < NEAR_STEADY * w.size[k] * forgotten:
            return False
    return True


@inlined
def finite(motion: SmoothMotion, z: np.ndarray) -> bool:
    """Return whether all numbers are finite."""
    total = motion.u_x + motion.u_y + motion.s_x + motion.s_y
    for k in range(len(z)):
        total += z[k]
    return isfinite(total)


@inlined
def keep(w: Workspace, z: np.ndarray, past: np.ndarray) -> None:
    """Store the states at the end of a step, and the values that predict the next.

    By number: an assignment of arrays takes 4 s to compile, for the words of its own errors.
    """
    for i in range(len(z)):
        z[i] = w.values[LAST, 2 + i]
    for k in range(len(past)):
        for i in range(past.shape[1]):
            past[k, i] = w.values[k, i]


@piece
def take_steps(
    problem: Problem,
    state: SmoothState,
    t_end: float,
    accuracy: Accuracy,
    budget: int,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
    w: Workspace,
    inner: Workspace,
) -> tuple[int, Numbers, int, int]:
    """Advance like `advance`, until the longest step is needed; then `w` has the rates."""
    motion, z, memory, counts = state
    past = memory.past
    h, h_last, warm = min(memory.h, accuracy.longest), memory.h_last, memory.warm
    before, limit = memory.ease, memory.limit
    code, turns = RUNNING, 0
    while turns < budget:
        if motion.t >= t_end:
            code = COMPLETED
            break
        if not finite(motion, z):
            code = NON_FINITE
            break
        start, q_x, q_y, at, slip, moved, apart = begin(problem, motion, z, w, accuracy)
        now = Time(motion.t, t_end - motion.t, varies(problem))
        there = limit_there(limit, h, now, apart, moved, slip, accuracy)
        if there[0] != ASKED or steady(w, now.left):
            limit = there
        if limit[0] == ASKED:
            keep_slopes(problem, at, w)
            write_rates(problem, w.jacobian[START], w.rates)
            code = ASKS
            break
        h = within_limit(h, limit)
        remember(w, past, start.eps)
        smooth = smooth_until(problem.bend, motion.t, t_end)
        done, taken, error, rejected, iterations = step(
            problem, start, q_x, q_y, smooth, h, h_last, warm, w, accuracy
        )
        counts = count_step(counts, rejected, iterations)
        turns += 1
        if not done:
            code = STEP_UNDERFLOW
            break
        k = sample(problem, start, taken, w, inner, accuracy, times, samples, k)
        end = smooth if start.t + taken >= smooth else start.t + taken
        motion = motion_at_end(problem, start, taken, end, w)
        keep(w, z, past)
        at_ease, short = ease(error), taken < CUT * h
        growth = max(GROWTH, EAGER * at_ease) if rejected == 0 else 1.0
        factor = step_factor(error, growth)
        if warm and not short:  # the errors of a step that was cut short show no trend
            factor = min(factor, trend(taken, h_last, at_ease, before))
        following, before = taken * factor, min(at_ease, CALMEST)
        cut = end == smooth and short  # its cubics do not reach across the next step
        h = min(max(h, following) if end == smooth else following, accuracy.longest)
        h_last, warm = taken, end < t_end and not cut
    if motion.t >= t_end:
        code = COMPLETED
    return code, (motion[:], (h, h_last, before, warm, limit), counts[:]), k, turns


@compiled
def advance(
    problem: Problem,
    state: SmoothState,
    t_end: float,
    accuracy: Accuracy,
    budget: int,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
    w: Workspace,
    inner: Workspace,
) -> tuple[int, Numbers, int, int]:
    """Advance until `t_end` or until the budget is used up, as `exact.loop.advance` does.

    The arrays of `state` change; returned is the rest of it, see `state.with_numbers`. Rows of
    `samples` are 7 + n long; see `stiction.solver.smooth.sampling`. `inner` is for steps within a
    step. No array is made here: to compile that takes half a second.
    """
    turns = 0
    while True:
        most = budget - turns
        code, numbers, k, used = take_steps(
            problem, state, t_end, accuracy, most, times, samples, k, w, inner
        )
        turns += used
        t, h, enough = numbers[0][0], numbers[1][0], numbers[1][4][1]
        if code != ASKS or grows(w.rates, w.growth, h, (t_end - t) / enough):
            return code, numbers, k, turns
        known = known_up_to(h, Time(t, t_end - t, varies(problem)))
        state = with_limit(with_numbers(state, numbers), (inf, known))
