"""Output samples inside a step; they do not influence the steps.

A row is one of `stiction.solver.exact.sampling`, followed by the internal states. As there, it is
the end of a shorter step from the same start.
"""

from __future__ import annotations

import numpy as np

from stiction.friction.law import Vector
from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import inlined
from stiction.solver.exact.sampling import COLUMNS
from stiction.solver.problem import Problem, at, cross_damping, drive_travel
from stiction.solver.smooth.coordinate import coordinate
from stiction.solver.smooth.error_estimate import balance, less_error, within
from stiction.solver.smooth.newton import solve
from stiction.solver.smooth.right_hand_side import SmoothOutset, acting
from stiction.solver.smooth.workspace import INSIDE, LAST, START, UNWANTED, Workspace
from stiction.solver.stepping.block_algebra import dot
from stiction.solver.stepping.radau import A, C, cubic


@inlined
def sample(
    problem: Problem,
    start: SmoothOutset,
    h: float,
    w: Workspace,
    inner: Workspace,
    accuracy: Accuracy,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
) -> int:
    """Fill the samples of an accepted step; return the next index."""
    while k < len(times) and times[k] <= start.t + h:
        dt = min(times[k] - start.t, h)
        x = dt / h
        d_x, d_y = drive_travel(problem, start.t, dt)
        u_x, u_y = start.u_x + d_x, start.u_y + d_y
        if dt > 0.0 and shorter(problem, start, x, h, w, inner, accuracy):
            v = inner.values
            u_x -= dt * dot(A[2], (v[1, 0], v[2, 0], v[3, 0]))
            u_y -= dt * dot(A[2], (v[1, 1], v[2, 1], v[3, 1]))
            slip, load = (v[LAST, 0], v[LAST, 1]), at(problem.load, start.t + dt)
            f = acting(problem, slip, load, inner, LAST, UNWANTED)
            write(problem, u_x, u_y, slip, (f[0], f[1]), samples, k)
            write_states(inner, LAST, samples, k)
        else:  # the weight grows from zero at the start, where the polynomial is exact
            p = less_error(w, within(w, x), x)
            nothing = (0.0, 0.0)
            slip = balance(problem, start, h, x, x, p, w, accuracy.newton, nothing).slip
            u_x, u_y = u_x - h * p.slid_x, u_y - h * p.slid_y
            f = acting(problem, slip, at(problem.load, start.t + dt), w, INSIDE, UNWANTED)
            write(problem, u_x, u_y, slip, (f[0], f[1]), samples, k)
            write_states(w, INSIDE, samples, k)
        k += 1
    return k


@inlined
def shorter(
    problem: Problem,
    start: SmoothOutset,
    x: float,
    h: float,
    w: Workspace,
    inner: Workspace,
    accuracy: Accuracy,
) -> bool:
    """Solve the first part x of a step by itself, into `inner`; return whether it converges."""
    n = w.size.shape[0]
    for k in range(n):
        inner.size[k] = w.size[k]
        inner.values[START, k] = w.values[START, k]
    c = C[0] * x, C[1] * x, C[2] * x
    p0, p1, p2 = within(w, c[0]), within(w, c[1]), within(w, c[2])
    a_x, a_y = coordinate(start.eps, p0.s_x, p0.s_y)
    b_x, b_y = coordinate(start.eps, p1.s_x, p1.s_y)
    c_x, c_y = coordinate(start.eps, p2.s_x, p2.s_y)
    for k in range(2, n):
        z = w.values[START, k], w.values[1, k], w.values[2, k], w.values[3, k]
        for i in range(3):
            inner.values[i + 1, k] = cubic(z, c[i])
    q_x, q_y = (a_x, b_x, c_x), (a_y, b_y, c_y)
    return bool(solve(problem, start, x * h, q_x, q_y, inner, accuracy)[0])


@inlined
def write(
    problem: Problem,
    u_x: float,
    u_y: float,
    slip: Vector,
    friction: Vector,
    samples: np.ndarray,
    k: int,
) -> None:
    """Write one row except the states."""
    m, row, c = problem.system.mass, samples[k], cross_damping(problem.rig)
    row[0], row[1], row[2], row[3] = u_x, u_y, slip[0], slip[1]
    row[4], row[5], row[6] = friction[0] * m - c * slip[1], friction[1] * m - c * slip[0], 0.0


@inlined
def write_states(w: Workspace, i: int, samples: np.ndarray, k: int) -> None:
    """Write the states in row `i` into one row of the samples."""
    for j in range(2, w.size.shape[0]):
        samples[k, COLUMNS + j - 2] = w.values[i, j]
