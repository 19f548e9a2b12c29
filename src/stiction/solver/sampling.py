"""Output samples from dense output; they do not influence the steps.

A row is u_x, u_y (m), slip_x, slip_y (m/s), friction_x, friction_y (N; while stuck, the
force that holds) and 1 while sticking, else 0.

Inside a slip step the slip distance is the quintic through its value and first two
derivatives at both ends, accurate to h^6 like the step itself; the direction of slip,
which must stay accurate where the slip vanishes, is the collocation cubic's.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from stiction.solver.blocks import Triple, dot
from stiction.solver.compiled import inlined
from stiction.solver.frame import Frame, Outset, elongation, friction
from stiction.solver.problem import Problem, in_principal_axes, travel
from stiction.solver.radau import A, cubic
from stiction.solver.slip import stage
from stiction.solver.stick import holding
from stiction.solver.surface import friction_along
from stiction.solver.swing import Oscillator, Swing, after, oscillator, swings

COLUMNS = 7


@inlined
def quintic(
    h: float, x: float, v0: float, a0: float, y1: float, v1: float, a1: float
) -> tuple[float, float]:
    """Return value and derivative at x h of the quintic with y(0) = 0 and the given ends."""
    b, c = v0 * h, 0.5 * a0 * h * h
    dy, dv, da = y1 - b - c, v1 * h - b - 2 * c, a1 * h * h - 2 * c
    c3, c4, c5 = 10 * dy - 4 * dv + 0.5 * da, 7 * dv - 15 * dy - da, 6 * dy - 3 * dv + 0.5 * da
    y = x * (b + x * (c + x * (c3 + x * (c4 + x * c5))))
    v = (b + x * (2 * c + x * (3 * c3 + x * (4 * c4 + x * 5 * c5)))) / h
    return y, v


@inlined
def sample_stick(
    problem: Problem,
    t: float,
    u_x: float,
    u_y: float,
    end: float,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
) -> int:
    """Fill the samples of a stick interval that starts at `t`; return the next index."""
    while k < len(times) and times[k] <= end:
        d_x, d_y = in_principal_axes(problem, travel(problem.drive, t, times[k] - t))
        a_x, a_y = holding(problem, times[k], u_x + d_x, u_y + d_y)
        samples[k, 0] = u_x + d_x
        samples[k, 1] = u_y + d_y
        samples[k, 2] = 0.0
        samples[k, 3] = 0.0
        samples[k, 4] = a_x * problem.system.mass
        samples[k, 5] = a_y * problem.system.mass
        samples[k, 6] = 1.0
        k += 1
    return k


@inlined
def sample_slip(
    problem: Problem,
    frame: Frame,
    start: Outset,
    swing: Swing,
    h: float,
    p: Triple,
    w: Triple,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
) -> int:
    """Fill the samples of an accepted slip step; return the next index."""
    t, r = frame.t, frame.r
    if k >= len(times) or times[k] > t + h:
        return k
    q = (p[0] * w[0], p[1] * w[1], p[2] * w[2])
    first_1, first_2 = start.a_1 - start.f, start.a_2 - start.turn
    end = stage(problem, frame, swing, h, 2, p, w, q)
    n = end.flow
    last_1, last_2 = end.a_1 - end.f * n.n_1, end.a_2 - end.f * (n.tau + w[2] * n.n_1)
    slid_1, slid_2 = h * (dot(A[2], p) + swing.slid[2]), h * dot(A[2], q)
    o, r_H, v_H, last_H, acc_H, slid_H = laid_over(frame, start, h)
    while k < len(times) and times[k] <= t + h:
        dt = times[k] - t
        x = dt / h
        z_1, s_1 = quintic(
            h, x, r - r_H, first_1 - v_H, slid_1 - slid_H, p[2] - last_H, last_1 - acc_H
        )
        if r_H != 0.0 or last_H != 0.0:
            p_H, _, d_H = after(o, dt)
            z_1, s_1 = z_1 + d_H, s_1 + p_H
        z_2, s_2 = quintic(h, x, 0.0, first_2, slid_2, q[2], last_2)
        u_x, u_y = elongation(problem, frame, dt, z_1, z_2)
        speed = sqrt(s_1 * s_1 + s_2 * s_2)
        turn = cubic((0.0, w[0], w[1], w[2]), x)
        g = 1.0 / sqrt(1.0 + turn * turn)
        force = friction(problem, times[k], speed)[0] * problem.system.mass
        k = fill(problem, frame, u_x, u_y, speed, g, turn * g, force, samples, k)
    return k


@inlined
def laid_over(
    frame: Frame, start: Outset, h: float
) -> tuple[Oscillator, float, float, float, float, float]:
    """Return what a step was laid over: p and p' at its start and end, and the distance."""
    o = oscillator(frame, start)
    if not swings(o, h):
        return o, 0.0, 0.0, 0.0, 0.0, 0.0
    p, v, slid = after(o, h)
    return o, frame.r, o.v, p, v, slid


@inlined
def fill(
    problem: Problem,
    frame: Frame,
    u_x: float,
    u_y: float,
    speed: float,
    n_1: float,
    n_2: float,
    force: float,
    samples: np.ndarray,
    k: int,
) -> int:
    """Write one row, with the slip along (n_1, n_2) in the step's axes; return the next index."""
    e_x, e_y = frame.e_x, frame.e_y
    n_x, n_y = n_1 * e_x - n_2 * e_y, n_1 * e_y + n_2 * e_x
    samples[k, 0] = u_x
    samples[k, 1] = u_y
    samples[k, 2] = speed * n_x
    samples[k, 3] = speed * n_y
    f_x, f_y = friction_along(problem, n_x, n_y)
    samples[k, 4] = force * f_x
    samples[k, 5] = force * f_y
    samples[k, 6] = 0.0
    return k + 1
