"""Output samples from dense output; they do not influence the steps.

A row is u_x, u_y (m), slip_x, slip_y (m/s), friction_x, friction_y (N; while stuck, the
force that holds) and 1 while sticking, else 0.

Inside a slip step they are the ends of shorter steps from its start; see `dense`.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from stiction.solver.blocks import Triple
from stiction.solver.compiled import inlined, piece
from stiction.solver.dense import within
from stiction.solver.frame import Frame, Outset, elongation, friction
from stiction.solver.motion import moving
from stiction.solver.problem import Problem, in_principal_axes, travel
from stiction.solver.state import Accuracy
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
    held: bool,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
) -> int:
    """Fill the samples of an interval of zero slip from `t` on; return the next index.

    It is a stick, or no more than a touch if not `held`.
    """
    while k < len(times) and times[k] <= end:
        d_x, d_y = in_principal_axes(problem, travel(problem.drive, t, times[k] - t))
        a_x, a_y = holding(problem, times[k], u_x + d_x, u_y + d_y)
        samples[k, 0] = u_x + d_x
        samples[k, 1] = u_y + d_y
        samples[k, 2] = 0.0
        samples[k, 3] = 0.0
        samples[k, 4] = a_x * problem.system.mass
        samples[k, 5] = a_y * problem.system.mass
        samples[k, 6] = 1.0 if held else 0.0
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
    accuracy: Accuracy,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
) -> int:
    """Fill the samples of an accepted slip step; return the next index."""
    if k >= len(times) or times[k] > frame.t + h:
        return k
    return sample_step(problem, frame, start, swing, h, p, w, accuracy, times, samples, k)


@piece
def sample_step(
    problem: Problem,
    frame: Frame,
    start: Outset,
    swing: Swing,
    h: float,
    p: Triple,
    w: Triple,
    accuracy: Accuracy,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
) -> int:
    """Fill the samples of a step that has some, by itself: the loop is faster without."""
    t, motion = frame.t, moving(problem, frame, start, accuracy)
    while k < len(times) and times[k] <= t + h:
        dt = min(times[k] - t, h)
        z_1, z_2, v, turn = within(problem, frame, start, swing, h, p, w, dt, accuracy, motion)
        u_x, u_y = elongation(problem, frame, dt, z_1, z_2)
        stretch = sqrt(1.0 + turn * turn)
        g, speed = 1.0 / stretch, v * stretch
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
