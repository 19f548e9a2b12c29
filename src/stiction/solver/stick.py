"""Stick: the elongation moves with the drive until friction reaches its limit."""

from __future__ import annotations

from math import inf, sqrt

from stiction.solver.compilation.jit import inlined
from stiction.solver.problem import (
    Problem,
    at,
    bend_after,
    constant,
    damping,
    drift,
    drive_rate,
    drive_rate_change,
    drive_rate_curve,
    drive_travel,
    smooth_until,
    static,
    steady,
)
from stiction.solver.stepping.radau import C
from stiction.solver.surface import held_product

USED_UP = 1e-14  # of f^2: the margin |a|^2 - f^2 is zero within rounding
NEARLY = 1e-9  # of f^2: over a limit by less, and falling, friction lets no slip rise that counts
MARGIN_LOOKS = 10_000  # evaluations of the margin before control returns to the loop


@inlined
def holding(problem: Problem, t: float, u_x: float, u_y: float) -> tuple[float, float]:
    """Return the friction force over mass (x, y) that keeps zero slip, in m/s^2.

    Eq. (1) with du/dt = v_d: (K u + C v_d)/m + dv_d/dt, the last only for a driven plate.
    """
    system = problem.system
    v_x, v_y = drive_rate(problem, t)
    g_x, g_y = drive_rate_change(problem, t)
    c_x, c_y = damping(problem, v_x, v_y)
    return (
        (system.k_x * u_x + c_x) * system.per_mass + system.inertia * g_x,
        (system.k_y * u_y + c_y) * system.per_mass + system.inertia * g_y,
    )


@inlined
def holding_change(problem: Problem, t: float) -> tuple[float, float]:
    """Return the rate of change of the value of `holding`, in m/s^3."""
    system = problem.system
    v_x, v_y = drive_rate(problem, t)
    g_x, g_y = drive_rate_change(problem, t)
    j_x, j_y = drive_rate_curve(problem, t)
    c_x, c_y = damping(problem, g_x, g_y)
    return (
        (system.k_x * v_x + c_x) * system.per_mass + system.inertia * j_x,
        (system.k_y * v_y + c_y) * system.per_mass + system.inertia * j_y,
    )


@inlined
def margin(problem: Problem, t: float, u_x: float, u_y: float) -> tuple[float, float, float]:
    """Return |a|^2 - f^2 and half its rate of change at zero slip (M6), and f^2.

    a is the friction over mass that keeps zero slip, f its limit; on an elliptic surface |a|^2 is
    a.N^-1 a.
    """
    a, j = holding(problem, t, u_x, u_y), holding_change(problem, t)
    per_weight = static(problem.law) * problem.system.per_mass
    f = per_weight * at(problem.load, t)
    change = held_product(problem, a, j) - f * per_weight * drift(problem.load, t)
    return held_product(problem, a, a) - f * f, change, f * f


@inlined
def half_bend(problem: Problem, t: float) -> float:
    """Return half the second derivative of the margin, or half its bound (M8) from `t` on.

    For a steady drive and load it is a constant, j.N^-1 j.
    """
    if steady(problem.drive) and constant(problem.load):
        j = holding_change(problem, t)
        return held_product(problem, j, j)
    return 0.5 * bend_after(problem.bend, t)


@inlined
def stick_duration(
    problem: Problem, t: float, u_x: float, u_y: float, t_stop: float
) -> tuple[float, bool]:
    """Return how long friction holds zero slip from time `t` on, and whether it ends then.

    Zero if friction cannot hold it even now, infinite if it can until `t_stop`. The time has a
    closed form for a steady drive and load (M7). Otherwise steps (M9) lead to the first zero of the
    margin, each so long that, by the bound of the margin's curvature, it contains no zero. They end
    where the drive or the load is not smooth, at the rows of a table.
    """
    excess, change, square = margin(problem, t, u_x, u_y)
    if excess > USED_UP * square or (excess >= 0.0 and change > 0.0):
        return 0.0, True
    if steady(problem.drive) and constant(problem.load):
        return used_up(excess, change, half_bend(problem, t)), True
    gone, now = 0.0, t
    for _ in range(MARGIN_LOOKS):
        if excess > -USED_UP * square and change > 0.0:
            return gone, True
        smooth = smooth_until(problem.bend, now, t_stop)
        # excess + 2 change x + bend x^2/2 < 0 before this
        x = used_up(min(excess, 0.0), change, half_bend(problem, now))
        if now + x >= smooth:  # beyond, the bound is another
            if smooth >= t_stop:
                return inf, True
            gone, now = smooth - t, smooth
        elif now + x == now:
            return gone, True
        else:
            gone += x
            now = t + gone
        d_x, d_y = drive_travel(problem, t, gone)
        excess, change, square = margin(problem, now, u_x + d_x, u_y + d_y)
    return gone, False


@inlined
def holds_on(problem: Problem, t: float, u_x: float, u_y: float, stop: float) -> bool:
    """Return whether friction, at its limit, holds zero slip until `stop` within rounding (M9a).

    The slip at the first stage of a step until then is proportional to the mean of the margin until
    there. Where that is rounding, the step could not rise from zero. A margin that falls at first
    must be nearly used up, or slip rises before; nor may it have risen again by then.
    """
    excess, change, square = margin(problem, t, u_x, u_y)
    bend, whole = half_bend(problem, t), stop - t
    x, rounding = C[0] * whole, USED_UP * square
    again = excess + (2.0 * change + bend * whole) * whole
    if change < 0.0 and (excess > NEARLY * square or not again < rounding):
        return False
    return excess + (change + bend / 3.0 * x) * x < rounding


@inlined
def to_spare(problem: Problem, t: float, u_x: float, u_y: float, duration: float) -> float:
    """Return the slip speed that the spare friction of a stick could absorb (M10), m/s.

    That is the integral over the stick of f - |a|, which is about linear in time and zero at the
    end. A slip that arrives faster by this amount does not stick.
    """
    excess, _, square = margin(problem, t, u_x, u_y)
    return -0.25 * excess / sqrt(square) * duration


@inlined
def used_up(constant: float, linear: float, quadratic: float) -> float:
    """Return the positive root of constant + 2 linear x + quadratic x^2, constant <= 0."""
    if quadratic == 0.0:
        return -0.5 * constant / linear if linear > 0.0 else inf
    root = sqrt(max(0.0, linear * linear - quadratic * constant))
    if linear > 0.0:
        return max(0.0, -constant / (linear + root))
    return (root - linear) / quadratic
