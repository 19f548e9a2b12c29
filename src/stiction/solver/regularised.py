"""The smoothed law F s/sqrt(|s|^2 + delta^2): the same collocation, in the axes (x, y).

For comparison with solvers that need it. There is no sticking: where the exact solution
sticks, this one creeps at about delta. The friction relaxes the slip at the rate
F/(m delta), so the step's error is filtered with it, or every step would be as short.
"""

from __future__ import annotations

from math import isfinite, sqrt
from typing import NamedTuple

import numpy as np

from stiction.solver.blocks import Factors, Triple, dot, eliminated, solved
from stiction.solver.compiled import compiled, inlined
from stiction.solver.frame import friction
from stiction.solver.newton import ITERATIONS
from stiction.solver.problem import Problem, in_principal_axes, next_break, travel
from stiction.solver.radau import (
    DEFECT_WEIGHT,
    DERIVATIVE,
    INTEGRAL,
    INTERIOR,
    VALUE,
    A,
    C,
    D,
    cubic,
    step_factor,
)
from stiction.solver.sampling import quintic
from stiction.solver.state import (
    COMPLETED,
    NON_FINITE,
    RUNNING,
    STEP_UNDERFLOW,
    Counts,
    Memory,
    Motion,
    State,
)
from stiction.solver.step import ATTEMPTS
from stiction.solver.stick import holding


class Change(NamedTuple):
    """Rate of change of the slip velocity, and minus its friction part's Jacobian, diagonal
    and off it (1/s)."""

    x: float
    y: float
    xx: float
    xy: float
    yy: float


@inlined
def change(
    problem: Problem,
    delta: float,
    start: Motion,
    dt: float,
    slid: tuple[float, float],
    s: tuple[float, float],
) -> Change:
    """Return ds/dt after `dt`, having slid `slid` (m), at slip velocity `s` (m/s)."""
    system = problem.system
    s_x, s_y = s
    d_x, d_y = in_principal_axes(problem, travel(problem.drive, start.t, dt))
    a_x, a_y = holding(problem, start.t + dt, start.u_x + d_x - slid[0], start.u_y + d_y - slid[1])
    c_x, c_y = system.c_x / system.mass, system.c_y / system.mass
    square = s_x * s_x + s_y * s_y
    r = sqrt(square)
    rho = sqrt(square + delta * delta)
    f, gradient = friction(problem, start.t + dt, r)
    f /= rho
    # d(F s/rho)/ds = (F/rho) I + (F'/(r rho) - F/rho^3) s s^T
    outer = gradient / (rho * max(r, 1e-300)) - f / (rho * rho)
    return Change(
        a_x - (c_x + f) * s_x,
        a_y - (c_y + f) * s_y,
        c_x + f + outer * s_x * s_x,
        outer * s_x * s_y,
        c_y + f + outer * s_y * s_y,
    )


@inlined
def changes(
    problem: Problem, delta: float, start: Motion, h: float, x: Triple, y: Triple
) -> tuple[Change, Change, Change]:
    """Return ds/dt at the three stages."""
    z0 = (h * dot(A[0], x), h * dot(A[0], y))
    z1 = (h * dot(A[1], x), h * dot(A[1], y))
    z2 = (h * dot(A[2], x), h * dot(A[2], y))
    return (
        change(problem, delta, start, C[0] * h, z0, (x[0], y[0])),
        change(problem, delta, start, C[1] * h, z1, (x[1], y[1])),
        change(problem, delta, start, h, z2, (x[2], y[2])),
    )


@inlined
def factors(problem: Problem, h: float, s: tuple[Change, Change, Change]) -> Factors:
    """Return the eliminated Jacobian of the collocation equations."""
    kx = h * h * problem.system.k_x / problem.system.mass
    ky = h * h * problem.system.k_y / problem.system.mass
    a, b, c = s
    return eliminated(
        (
            (D[0][0] + kx * A[0][0] + h * a.xx, D[0][1] + kx * A[0][1], D[0][2] + kx * A[0][2]),
            (D[1][0] + kx * A[1][0], D[1][1] + kx * A[1][1] + h * b.xx, D[1][2] + kx * A[1][2]),
            (D[2][0] + kx * A[2][0], D[2][1] + kx * A[2][1], D[2][2] + kx * A[2][2] + h * c.xx),
        ),
        ((h * a.xy, 0.0, 0.0), (0.0, h * b.xy, 0.0), (0.0, 0.0, h * c.xy)),
        ((h * a.xy, 0.0, 0.0), (0.0, h * b.xy, 0.0), (0.0, 0.0, h * c.xy)),
        (
            (D[0][0] + ky * A[0][0] + h * a.yy, D[0][1] + ky * A[0][1], D[0][2] + ky * A[0][2]),
            (D[1][0] + ky * A[1][0], D[1][1] + ky * A[1][1] + h * b.yy, D[1][2] + ky * A[1][2]),
            (D[2][0] + ky * A[2][0], D[2][1] + ky * A[2][1], D[2][2] + ky * A[2][2] + h * c.yy),
        ),
    )


@inlined
def solve(
    problem: Problem,
    delta: float,
    start: Motion,
    h: float,
    x: Triple,
    y: Triple,
    tolerance: float,
    speed: float,
) -> tuple[bool, Triple, Triple, int]:
    """Solve the collocation equations by Newton's method; return (converged, x, y, count)."""
    x0, y0 = start.r * start.e_x, start.r * start.e_y
    last = 1e300
    for iteration in range(1, ITERATIONS + 1):
        s = changes(problem, delta, start, h, x, y)
        from_x, from_y = (x[0] - x0, x[1] - x0, x[2] - x0), (y[0] - y0, y[1] - y0, y[2] - y0)
        dx, dy = solved(
            factors(problem, h, s),
            (
                dot(D[0], from_x) - h * s[0].x,
                dot(D[1], from_x) - h * s[1].x,
                dot(D[2], from_x) - h * s[2].x,
            ),
            (
                dot(D[0], from_y) - h * s[0].y,
                dot(D[1], from_y) - h * s[1].y,
                dot(D[2], from_y) - h * s[2].y,
            ),
        )
        x = (x[0] - dx[0], x[1] - dx[1], x[2] - dx[2])
        y = (y[0] - dy[0], y[1] - dy[1], y[2] - dy[2])
        size = max(abs(dx[0]), abs(dx[1]), abs(dx[2]), abs(dy[0]), abs(dy[1]), abs(dy[2]))
        size /= speed + sqrt(x[2] * x[2] + y[2] * y[2])
        if not size < 1e10 or (iteration > 3 and size > last):
            return False, x, y, iteration
        if size < 0.01 * tolerance:
            return True, x, y, iteration
        last = size
    return False, x, y, ITERATIONS


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
    tolerance: float,
    speed: float,
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
        converged, x, y, count = solve(problem, delta, start, h, x, y, tolerance, speed)
        iterations += count
        factor = 0.3
        if converged:
            error = local_error(problem, delta, start, h, x, y, speed) / tolerance
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
    tolerance: float,
    speed: float,
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
        t_stop = min(t_end, next_break(problem.drive, start.t))
        done, h, x, y, error, rejected, iterations = step(
            problem, delta, start, t_stop, memory, tolerance, speed
        )
        counts = Counts(
            counts.steps + 1,
            counts.rejected + rejected,
            counts.iterations + iterations,
            counts.sticks,
            counts.stuck,
        )
        if not done:
            return STEP_UNDERFLOW, State(start, memory, counts), k, turn
        k = sample(problem, delta, start, h, x, y, times, samples, k)
        x0, y0 = start.r * start.e_x, start.r * start.e_y
        end = t_stop if start.t + h >= t_stop else start.t + h
        d_x, d_y = in_principal_axes(problem, travel(problem.drive, start.t, h))
        r = sqrt(x[2] * x[2] + y[2] * y[2])
        e_x, e_y = (x[2] / r, y[2] / r) if r > 0.0 else (1.0, 0.0)
        motion = Motion(
            end, start.u_x + d_x - h * dot(A[2], x), start.u_y + d_y - h * dot(A[2], y), r, e_x, e_y
        )
        following = memory.h if end == t_stop else h * step_factor(error, 2.0)
        memory = Memory(
            following,
            following,
            h,
            1.0,
            end < t_stop,
            (x0, x[0], x[1], x[2]),
            (y0, y[0], y[1], y[2]),
        )
        state = State(motion, memory, counts)
    return RUNNING, state, k, budget
