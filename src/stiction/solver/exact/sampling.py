"""Output samples, which do not influence the steps.

A row is u_x, u_y (m), slip_x, slip_y (m/s), friction_x, friction_y (N; while stuck, the
force that holds) and 1 while sticking, else 0.

The collocation polynomial of a step is less accurate inside than at the end, by two orders.
Therefore a value inside is the end of a shorter step from the same start, with that polynomial as
first guess. This mostly takes one iteration, and equals the result of a run that ends there. Where
the polynomial is accurate enough, as for measures and pictures, it costs a sixth.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import inlined
from stiction.solver.exact.collocation import SlipStep, products
from stiction.solver.exact.error_estimate import moving
from stiction.solver.exact.newton import solve
from stiction.solver.exact.oscillation import NO_LANDING, after, oscillator, still, swing, swings
from stiction.solver.exact.record import on_polynomial
from stiction.solver.exact.slip_frame import Frame, Outset, elongation, friction
from stiction.solver.problem import Problem, drive_travel
from stiction.solver.state import Motion
from stiction.solver.stepping.block_algebra import Triple, dot, less
from stiction.solver.stepping.radau import A, C, cubic
from stiction.solver.stick import holding
from stiction.solver.surface import Tensor, friction_along, speed_ratio

COLUMNS = 7


@inlined
def within(
    problem: Problem,
    frame: Frame,
    start: Outset,
    step: SlipStep,
    dt: float,
    accuracy: Accuracy,
    motion: float,
) -> tuple[float, float, float, float]:
    """Return the distance slipped after `dt` along and across the step, and p and w then."""
    if dt <= 0.0:
        return 0.0, 0.0, frame.r, 0.0
    laid, h, p, w = step
    if dt == h:
        return end_of_step(step)
    o, x, rest, across = oscillator(frame, start), dt / h, less(p, laid.p), products(p, w)
    if accuracy.inside >= accuracy.tolerance:
        return on_polynomial(frame.r, h, swings(o, h), o, rest, w, across, dt)
    way = 0.0, w[0], w[1], w[2]
    # in a step longer than an oscillation nothing swings, nor does it in a part of that step
    s = swing(o, dt, NO_LANDING) if swings(o, h) else still()
    if swings(o, h) and swings(o, dt):
        q = (
            s.p[0] + on_cubic(0.0, rest, C[0] * x),
            s.p[1] + on_cubic(0.0, rest, C[1] * x),
            s.p[2] + on_cubic(0.0, rest, x),
        )
    elif swings(o, h):
        q = (
            after(o, C[0] * dt)[0] + on_cubic(0.0, rest, C[0] * x),
            after(o, C[1] * dt)[0] + on_cubic(0.0, rest, C[1] * x),
            after(o, dt)[0] + on_cubic(0.0, rest, x),
        )
    else:
        q = (
            on_cubic(frame.r, rest, C[0] * x),
            on_cubic(frame.r, rest, C[1] * x),
            on_cubic(frame.r, rest, x),
        )
    turn = cubic(way, C[0] * x), cubic(way, C[1] * x), cubic(way, x)
    shorter = SlipStep(s, dt, q, turn)
    found, shorter, _ = solve(problem, frame, o, shorter, NO_LANDING, accuracy, motion)
    if found and min(shorter.p) >= 0.0:
        return end_of_step(shorter)
    return on_polynomial(frame.r, h, swings(o, h), o, rest, w, across, dt)


@inlined
def end_of_step(step: SlipStep) -> tuple[float, float, float, float]:
    """Return the distance slipped in a step along and across it, and p and w at its end."""
    s, h, p, w = step
    return h * (dot(A[2], p) + s.slid[2]), h * dot(A[2], products(p, w)), p[2], w[2]


@inlined
def on_cubic(first: float, values: Triple, x: float) -> float:
    """Return the cubic through a value at the start and those at the stages."""
    return cubic((first, values[0], values[1], values[2]), x)


@inlined
def sample_stick(
    problem: Problem,
    t: float,
    u_x: float,
    u_y: float,
    end: float,
    is_stick: bool,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
) -> int:
    """Fill the samples of an interval of zero slip from `t` on; return the next index.

    It is a stick if `is_stick`, else only a touch.
    """
    while k < len(times) and times[k] <= end:
        d_x, d_y = drive_travel(problem, t, times[k] - t)
        a_x, a_y = holding(problem, times[k], u_x + d_x, u_y + d_y)
        samples[k, 0] = u_x + d_x
        samples[k, 1] = u_y + d_y
        samples[k, 2] = 0.0
        samples[k, 3] = 0.0
        samples[k, 4] = a_x * problem.system.mass
        samples[k, 5] = a_y * problem.system.mass
        samples[k, 6] = 1.0 if is_stick else 0.0
        k += 1
    return k


@inlined
def sample_slip(
    problem: Problem,
    frame: Frame,
    start: Outset,
    step: SlipStep,
    accuracy: Accuracy,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
) -> int:
    """Fill the samples of an accepted slip step; return the next index."""
    h = step.h
    if k >= len(times) or times[k] > frame.t + h:
        return k
    motion, _ = moving(problem, frame, start, accuracy)
    while k < len(times) and times[k] <= frame.t + h:
        dt = min(times[k] - frame.t, h)
        slip = within(problem, frame, start, step, dt, accuracy, motion)
        k = write_slip(problem, frame, frame.metric, times[k], dt, slip, samples, k)
    return k


@inlined
def write_slip(
    problem: Problem,
    frame: Frame | Motion,
    metric: Tensor,
    t: float,
    dt: float,
    slip: tuple[float, float, float, float],
    samples: np.ndarray,
    k: int,
) -> int:
    """Write the row at `t`, `dt` after a step's start; return the next index.

    `slip` is what `within` returns, `metric` the rig's tensor in the step's axes.
    """
    z_1, z_2, v, turn = slip
    u_x, u_y = elongation(problem, frame, dt, z_1, z_2)
    stretch = sqrt(1.0 + turn * turn)
    g, speed = 1.0 / stretch, v * stretch
    true = v * speed_ratio(problem, metric, turn)
    force = friction(problem, t, true)[0] * problem.system.mass
    return fill(problem, frame, u_x, u_y, speed, g, turn * g, force, samples, k)


@inlined
def fill(
    problem: Problem,
    frame: Frame | Motion,
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
