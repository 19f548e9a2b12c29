"""The axes in which one step of slip is computed.

e is the slip direction at the step's start (at take-off: the direction of the force that
held). In these axes the slip velocity is s = p (1, w) (M11), and with a = (K u + C du/dt)/m +
dv_d/dt (M2) (the last only where the plate is driven) and f = F(|s|)/m, Eqs. (4) and (5) read,
on an isotropic surface,

    p'   = a_1 - f/sqrt(1 + w^2)        (M13)
    p w' = a_2 - w a_1                  (M14)

These are regular at p = 0: friction acts along the slip and cannot turn it.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from stiction.solver.compilation.jit import inlined
from stiction.solver.problem import (
    Problem,
    at,
    coefficient_and_slope,
    cross_damping,
    drive_rate,
    drive_travel,
    in_solver_axes,
    is_aligned,
    rate,
    rate_change,
    rate_curve,
    steady,
    travel,
)
from stiction.solver.state import Motion
from stiction.solver.surface import (
    Tensor,
    friction_direction,
    metric_into,
    speed_ratio,
    tensor_into,
    turned_into,
)


class Frame(NamedTuple):
    """The axes of a step: direction e, the laboratory's X and Y in them, tensors over mass.

    Also the surface's tensor N and the rig's G (see `surface`), and the step's start: time,
    elongation (u_x, u_y), slip speed r, and the spring's acceleration along and across e; for a
    steady drive also the drive's contribution to it, and its rate.
    """

    e_x: float
    e_y: float
    X_1: float
    X_2: float
    Y_1: float
    Y_2: float
    k_11: float
    k_12: float
    k_22: float
    c_11: float
    c_12: float
    c_22: float
    surface: Tensor
    metric: Tensor
    t: float
    u_x: float
    u_y: float
    r: float
    spring_1: float
    spring_2: float
    drive_1: float
    drive_2: float
    change_1: float
    change_2: float


class Outset(NamedTuple):
    """Forces over mass at a step's start: acceleration a along and across e, and its rate of
    change by the drive alone; friction against e, its slope, and the part that turns the slip."""

    a_1: float
    a_2: float
    da_1: float
    da_2: float
    f: float
    gradient: float
    turn: float


@inlined
def frame_of(problem: Problem, motion: Motion) -> Frame:
    """Return the axes along the slip direction."""
    s = problem.system
    _, u_x, u_y, r, e_x, e_y = motion
    k_x, k_y = s.k_x * s.per_mass, s.k_y * s.per_mass
    c_x, c_y = s.c_x * s.per_mass, s.c_y * s.per_mass
    xx, xy, yy = e_x * e_x, e_x * e_y, e_y * e_y
    X_x, X_y = in_solver_axes(problem, (1.0, 0.0))
    Y_x, Y_y = in_solver_axes(problem, (0.0, 1.0))
    v_x = v_y = 0.0
    if steady(problem.drive):
        v_x, v_y = drive_rate(problem, motion.t)
    d_x, d_y = c_x * v_x, c_y * v_y
    damping = Tensor(c_x * xx + c_y * yy, (c_y - c_x) * xy, c_y * xx + c_x * yy)
    if not is_aligned(problem.rig):
        c_xy = cross_damping(problem.rig) * s.per_mass
        d_x, d_y = d_x + c_xy * v_y, d_y + c_xy * v_x
        damping = tensor_into(Tensor(c_x, c_xy, c_y), e_x, e_y)
    return Frame(
        e_x,
        e_y,
        X_x * e_x + X_y * e_y,
        X_y * e_x - X_x * e_y,
        Y_x * e_x + Y_y * e_y,
        Y_y * e_x - Y_x * e_y,
        k_x * xx + k_y * yy,
        (k_y - k_x) * xy,
        k_y * xx + k_x * yy,
        damping.xx,
        damping.xy,
        damping.yy,
        turned_into(problem, e_x, e_y),
        metric_into(problem, e_x, e_y),
        motion.t,
        u_x,
        u_y,
        r,
        # from the forces: rotating u would carry rounding of u_x into the stiff direction
        k_x * u_x * e_x + k_y * u_y * e_y,
        k_y * u_y * e_x - k_x * u_x * e_y,
        d_x * e_x + d_y * e_y,
        d_y * e_x - d_x * e_y,
        k_x * v_x * e_x + k_y * v_y * e_y,
        k_y * v_y * e_x - k_x * v_x * e_y,
    )


@inlined
def outset(problem: Problem, frame: Frame) -> Outset:
    """Return the forces over mass at the start of a step."""
    b_1, b_2, db_1, db_2 = pull(problem, frame, 0.0)
    per_p = speed_ratio(problem, frame.metric, 0.0)
    f, gradient = friction(problem, frame.t, frame.r * per_p)
    gradient *= per_p
    along = friction_direction(problem, frame.surface, 0.0)
    return Outset(
        b_1 - frame.c_11 * frame.r,
        b_2 - frame.c_12 * frame.r,
        db_1,
        db_2,
        f * along.n_1,
        gradient * along.n_1,
        f * along.tau,
    )


@inlined
def in_frame(problem: Problem, frame: Frame, vector: tuple[float, float]) -> tuple[float, float]:
    """Return a laboratory vector (X, Y) in the step's axes."""
    X, Y = vector
    if is_aligned(problem.rig):
        return X * frame.X_1 - Y * frame.X_2, X * frame.X_2 + Y * frame.X_1
    return X * frame.X_1 + Y * frame.Y_1, X * frame.X_2 + Y * frame.Y_2


@inlined
def pull(problem: Problem, frame: Frame, dt: float) -> tuple[float, float, float, float]:
    """Return the acceleration by the drive alone after `dt`, b of (M17), and its change.

    It supposes the elongation at the start plus the drive's travel; the caller adds the effect of
    slip.
    """
    if steady(problem.drive):
        x, y = frame.change_1, frame.change_2
        return (
            frame.spring_1 + frame.drive_1 + x * dt,
            frame.spring_2 + frame.drive_2 + y * dt,
            x,
            y,
        )
    t = frame.t
    d_1, d_2 = in_frame(problem, frame, travel(problem.drive, t, dt))
    v_1, v_2 = in_frame(problem, frame, rate(problem.drive, t + dt))
    g_1, g_2 = in_frame(problem, frame, rate_change(problem.drive, t + dt))
    j_1, j_2 = in_frame(problem, frame, rate_curve(problem.drive, t + dt))
    inertia = problem.system.inertia
    k_11, k_12, k_22 = frame.k_11, frame.k_12, frame.k_22
    c_11, c_12, c_22 = frame.c_11, frame.c_12, frame.c_22
    return (
        frame.spring_1 + k_11 * d_1 + k_12 * d_2 + c_11 * v_1 + c_12 * v_2 + inertia * g_1,
        frame.spring_2 + k_12 * d_1 + k_22 * d_2 + c_12 * v_1 + c_22 * v_2 + inertia * g_2,
        k_11 * v_1 + k_12 * v_2 + c_11 * g_1 + c_12 * g_2 + inertia * j_1,
        k_12 * v_1 + k_22 * v_2 + c_12 * g_1 + c_22 * g_2 + inertia * j_2,
    )


@inlined
def friction(problem: Problem, t: float, r: float) -> tuple[float, float]:
    """Return the friction force over mass and its slope at slip speed `r`.

    Below zero the law is extrapolated linearly: an iterate may overshoot a landing.
    """
    weight = at(problem.load, t) * problem.system.per_mass
    v = max(r, 0.0)
    mu, gradient = coefficient_and_slope(problem.law, v)
    gradient *= weight
    return mu * weight + gradient * (r - v), gradient


@inlined
def elongation(
    problem: Problem, frame: Frame | Motion, dt: float, slid_1: float, slid_2: float
) -> tuple[float, float]:
    """Return the elongation after `dt`, having slid (slid_1, slid_2) in the step's axes (M30)."""
    d_x, d_y = drive_travel(problem, frame.t, dt)
    e_x, e_y = frame.e_x, frame.e_y
    return (
        frame.u_x + (d_x - (slid_1 * e_x - slid_2 * e_y)),
        frame.u_y + (d_y - (slid_1 * e_y + slid_2 * e_x)),
    )


@inlined
def turned_direction(frame: Frame, w: float) -> tuple[float, float]:
    """Return the direction of (1, w) in the axes (x, y)."""
    g = 1.0 / sqrt(1.0 + w * w)
    return (frame.e_x - w * frame.e_y) * g, (frame.e_y + w * frame.e_x) * g
