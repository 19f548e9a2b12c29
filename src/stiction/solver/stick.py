"""Sticking: the elongation moves with the drive until the friction that holds is used up."""

from __future__ import annotations

from math import inf, sqrt

from stiction.solver.compiled import inlined
from stiction.solver.problem import (
    Problem,
    at,
    coefficient,
    in_principal_axes,
    rate,
    rate_change,
)


@inlined
def holding(problem: Problem, t: float, u_x: float, u_y: float) -> tuple[float, float]:
    """Return the friction force over mass (x, y) that zero slip takes, in m/s^2.

    Eq. (1) with du/dt = v_d: (K u + C v_d)/m + dv_d/dt.
    """
    system = problem.system
    v_x, v_y = in_principal_axes(problem, rate(problem.drive, t))
    g_x, g_y = in_principal_axes(problem, rate_change(problem.drive, t))
    return (
        (system.k_x * u_x + system.c_x * v_x) * system.per_mass + g_x,
        (system.k_y * u_y + system.c_y * v_y) * system.per_mass + g_y,
    )


@inlined
def limit(problem: Problem, t: float) -> float:
    """Return the largest friction force over mass at zero slip, in m/s^2."""
    return coefficient(problem.law, 0.0) * at(problem.load, t) * problem.system.per_mass


@inlined
def stick_duration(problem: Problem, t: float, u_x: float, u_y: float) -> float:
    """Return how long zero slip can be held from time `t` on, for a steady drive and load.

    The root of |K (u + v_d tau) + C v_d| = mu_0 W, a quadratic in tau; zero if the
    friction cannot hold even now, infinite if it always can.
    """
    system = problem.system
    v_x, v_y = in_principal_axes(problem, rate(problem.drive, t))
    a_x, a_y = holding(problem, t, u_x, u_y)
    j_x, j_y = system.k_x * v_x * system.per_mass, system.k_y * v_y * system.per_mass
    f = limit(problem, t)
    quadratic = j_x * j_x + j_y * j_y
    linear = a_x * j_x + a_y * j_y
    constant = a_x * a_x + a_y * a_y - f * f
    if constant > 1e-14 * f * f or (constant >= 0.0 and linear > 0.0):
        return 0.0
    if quadratic == 0.0:
        return inf
    root = sqrt(max(0.0, linear * linear - quadratic * constant))
    if linear > 0.0:
        return max(0.0, -constant / (linear + root))
    return (root - linear) / quadratic
