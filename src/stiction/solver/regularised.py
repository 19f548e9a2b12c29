"""The loop for the smoothed law, for comparison with solvers that need it.

There is no sticking: where the exact solution sticks, this one creeps at about delta. The
friction relaxes the slip at the rate F/(m delta), so the step's error is filtered with it,
or every step would be as short.
"""

from __future__ import annotations

from math import isfinite, sqrt

import numpy as np

from stiction.solver.blocks import Triple, dot
from stiction.solver.compiled import compiled, inlined
from stiction.solver.frame import friction
from stiction.solver.problem import Problem, in_principal_axes, travel
from stiction.solver.radau import (
    DEFECT_WEIGHT,
    DERIVATIVE,
    INTEGRAL,
    INTERIOR,
    VALUE,
    A,
    C,
    cubic,
    step_factor,
)
from stiction.solver.sampling import quintic
from stiction.solver.smoothed import change, solve
from stiction.solver.state import (
    COMPLETED,
    NON_FINITE,
    RUNNING,
    STEP_UNDERFLOW,
    Accuracy,
    Memory,
    Motion,
    State,
    counted,
)
from stiction.solver.step import ATTEMPTS


@inlined
def local_error(
    problem: Problem, delta: float, start: Motion, h: float, x: Triple, y: Triple, speed: float
) -> float:
    """Return the relative error of the collocation cubic: its filtered defect inside the step."""
    x0, y0 = start.r * start.e_x, start.r * start.e_y
    s_x = VALUE[0] * x0 + VALUE[1] * x[0] + VALUE[2] * x[1] + VALUE[3] * x[2]
    s_y = VALUE[0] * y0 + VALUE[1] * y[0] + VALUE[2] * y[1] + VALUE[3] * y[2]
    dx = DERIVATIVE[0] * x0 + DERIVATIVE[1] * x[0] + DERIVATIVE[2] * x[1] + DERIVATIVE[3] * x[2]
    dy = DERIVATIVE[0] * y0 + DERIVATIVE[1] * y[0] + DERIVATIVE[2] * y[1] + DERIVATIVE[3] * y[2]
    slid = (h * dot(INTEGRAL, x), h * dot(INTEGRAL, y))
    c = change(problem, delta, start, INTERIOR * h, slid, (s_x, s_y))
    e_x, e_y = dx - h * c.x, dy - h * c.y
    g = DEFECT_WEIGHT * h
    xx, xy, yy = 1.0 + g * c.xx, g * c.xy, 1.0 + g * c.yy
    q = DEFECT_WEIGHT / (xx * yy - xy * xy)
    e_x, e_y = q * (yy * e_x - xy * e_y), q * (xx * e_y - xy * e_x)
    return sqrt(e_x * e_x + e_y * e_y) / (speed + sqrt(s_x * s_x + s_y * s_y))


@inlined
def predicted(start: Motion, h: float, memory: Memory) -> tuple[Triple, Triple]:
    """Return a first guess of the stages."""
    x0, y0 = start.r * start.e_x, start.r * start.e_y
    if not memory.warm:
        return (x0, x0, x0), (y0, y0, y0)
    q = h / memory.h_last
    c = (1.0 + C[0] * q, 1.0 + C[1] * q, 1.0 + C[2] * q)
    x, y = memory.p, memory.w
    return (
        (cubic(x, c[0]), cubic(x, c[1]), cubic(x, c[2])),
        (cubic(y, c[0]), cubic(y, c[1]), cubic(y, c[2])),
    )


@inlined
def sample(
    problem: Problem,
    delta: float,
    start: Motion,
    h: float,
    x: Triple,
    y: Triple,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
) -> int:
    """Fill the samples of an accepted step; return the next index."""
    x0, y0 = start.r * start.e_x, start.r * start.e_y
    first = change(problem, delta, start, 0.0, (0.0, 0.0), (x0, y0))
    z_x, z_y = h * dot(A[2], x), h * dot(A[2], y)
    last = change(problem, delta, start, h, (z_x, z_y), (x[2], y[2]))
    while k < len(times) and times[k] <= start.t + h:
        dt = times[k] - start.t
        d_x, d_y = in_principal_axes(problem, travel(problem.drive, start.t, dt))
        at_x, s_x = quintic(h, dt / h, x0, first.x, z_x, x[2], last.x)
        at_y, s_y = quintic(h, dt / h, y0, first.y, z_y, y[2], last.y)
        square = s_x * s_x + s_y * s_y
        f = friction(problem, times[k], sqrt(square))[0] / sqrt(square + delta * delta)
        f *= problem.system.mass
        samples[k, 0] = start.u_x + d_x - at_x
        samples[k, 1] = start.u_y + d_y - at_y
        samples[k, 2] = s_x
        samples[k, 3] = s_y
        samples[k, 4] = f * s_x
        samples[k, 5] = f * s_y
        samples[k, 6] = 0.0
        k += 1
    return k


@inlined
def step(
    problem: Problem,
    delta: float,
    start: Motion,
    t_stop: float,
    memory: Memory,
    accuracy: Accuracy,
) -> tuple[bool, float, Triple, Triple, float, int, int]:
    """Take one step; return (done, h, x, y, error over tolerance, rejected, iterations)."""
    h = memory.h
    rejected = iterations = 0
    x = y = (0.0, 0.0, 0.0)
    for _ in range(ATTEMPTS):
        if start.t + h >= t_stop:
            h = t_stop - start.t
        elif not h > 4e-16 * abs(start.t):
            break
        x, y = predicted(start, h, memory)
        converged, x, y, count = solve(problem, delta, start, h, x, y, accuracy)
        iterations += count
        factor = 0.3
        if converged:
            error = local_error(problem, delta, start, h, x, y, accuracy.speed) / accuracy.tolerance
            if error <= 1.0:
                return True, h, x, y, error, rejected, iterations
            factor = step_factor(error, 1.0)
        rejected += 1
        h *= factor
    return False, h, x, y, 0.0, rejected, iterations


@compiled
def advance(
    problem: Problem,
    delta: float,
    state: State,
    t_end: float,
    accuracy: Accuracy,
    budget: int,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
) -> tuple[int, State, int, int]:
    """Advance until `t_end` or until the budget is used up; as `stiction.solver.loop.advance`."""
    for turn in range(budget):
        start, memory, counts = state
        if start.t >= t_end:
            return COMPLETED, state, k, turn
        if not (isfinite(start.u_x) and isfinite(start.u_y) and isfinite(start.r)):
            return NON_FINITE, state, k, turn
        done, h, x, y, error, rejected, iterations = step(
            problem, delta, start, t_end, memory, accuracy
        )
        counts = counted(counts, rejected, iterations)
        if not done:
            return STEP_UNDERFLOW, State(start, memory, counts), k, turn
        k = sample(problem, delta, start, h, x, y, times, samples, k)
        x0, y0 = start.r * start.e_x, start.r * start.e_y
        end = t_end if start.t + h >= t_end else start.t + h
        d_x, d_y = in_principal_axes(problem, travel(problem.drive, start.t, h))
        r = sqrt(x[2] * x[2] + y[2] * y[2])
        e_x, e_y = (x[2] / r, y[2] / r) if r > 0.0 else (1.0, 0.0)
        motion = Motion(
            end, start.u_x + d_x - h * dot(A[2], x), start.u_y + d_y - h * dot(A[2], y), r, e_x, e_y
        )
        following = memory.h if end == t_end else h * step_factor(error, 2.0)
        memory = Memory(
            following,
            following,
            h,
            1.0,
            end < t_end,
            (x0, x[0], x[1], x[2]),
            (y0, y[0], y[1], y[2]),
        )
        state = State(motion, memory, counts)
    code = COMPLETED if state.motion.t >= t_end else RUNNING
    return code, state, k, budget
