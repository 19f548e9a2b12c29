"""Output samples from dense output; they do not influence the steps.

A row is u_x, u_y (m), slip_x, slip_y (m/s), friction_x, friction_y (N; while stuck, the
force that holds) and 1 while sticking, else 0.

Inside a slip step distances are those of `dense`; the direction of slip, which must stay
accurate where the slip vanishes, is the collocation cubic's.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from stiction.solver.blocks import Triple
from stiction.solver.compiled import inlined
from stiction.solver.dense import ends_of, within
from stiction.solver.frame import Frame, Outset, elongation, friction
from stiction.solver.newton import products
from stiction.solver.problem import Problem, in_principal_axes, travel
from stiction.solver.radau import cubic
from stiction.solver.stick import holding
from stiction.solver.surface import friction_along
from stiction.solver.swing import Swing

COLUMNS = 7


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
    t = frame.t
    if k >= len(times) or times[k] > t + h:
        return k
    ends = ends_of(problem, frame, start, swing, h, p, w)
    while k < len(times) and times[k] <= t + h:
        dt = times[k] - t
        z_1, z_2, s_1, s_2 = within(frame, swing, ends, h, p, products(p, w), dt)
        turn = cubic((0.0, w[0], w[1], w[2]), dt / h)
        u_x, u_y = elongation(problem, frame, dt, z_1, z_2)
        speed = sqrt(s_1 * s_1 + s_2 * s_2)
        g = 1.0 / sqrt(1.0 + turn * turn)
        force = friction(problem, times[k], speed)[0] * problem.system.mass
        k = fill(problem, frame, u_x, u_y, speed, g, turn * g, force, samples, k)
    return k


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
