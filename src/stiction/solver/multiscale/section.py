"""The ends of sticks: with a steady drive and load, a closed curve with one angle on it.

There friction is at its limit, |a| = f with a = (K u + C v_d)/m and f = F(0)/m; on an elliptic
surface a.N^-1 a = f^2 (see `surface`). With N = L L^T, a = f L (cos, sin) of the angle (M52).
"""

from __future__ import annotations

from math import atan2, cos, pi, sin, sqrt

from stiction.solver.compilation.jit import inlined
from stiction.solver.problem import Problem, at, damping, drive_rate, static
from stiction.solver.stick import holding, holding_change
from stiction.solver.surface import held_product

ROUNDING_OF_COSINE = 1e-15  # as in system.tensors: that of pi/2, rounded, is 6e-17


@inlined
def angle(problem: Problem, u_x: float, u_y: float) -> float:
    """Return the angle of the limiting friction at an elongation, -pi to pi."""
    n, (a_x, a_y) = problem.surface, holding(problem, 0.0, u_x, u_y)
    x = a_x / sqrt(n.xx)
    return atan2((a_y - n.xy / sqrt(n.xx) * x) / sqrt(n.yy - n.xy * n.xy / n.xx), x)


@inlined
def limit_at_angle(problem: Problem, theta: float) -> tuple[float, float]:
    """Return the limit of friction at an angle, over mass (x, y)."""
    n, f = problem.surface, static(problem.law) * at(problem.load, 0.0) * problem.system.per_mass
    c, s = cos(theta), sin(theta)
    c, s = 0.0 if abs(c) < ROUNDING_OF_COSINE else c, 0.0 if abs(s) < ROUNDING_OF_COSINE else s
    x, y = f * c / sqrt(n.xx), f * s * sqrt(n.yy - n.xy * n.xy / n.xx)
    return n.xx * x, n.xy * x + y


@inlined
def elongation_held(problem: Problem, theta: float) -> tuple[float, float]:
    """Return the elongation (x, y) at which a stick ends."""
    s, (a_x, a_y) = problem.system, limit_at_angle(problem, theta)
    v_x, v_y = drive_rate(problem, 0.0)
    c_x, c_y = damping(problem, v_x, v_y)
    return (s.mass * a_x - c_x) / s.k_x, (s.mass * a_y - c_y) / s.k_y


@inlined
def lead(problem: Problem, theta: float) -> float:
    """Return the longest time by which a stick's start precedes its end at an angle; 0 if none.

    It covers half of the chord of a in the ellipse (M54).
    """
    a, j = limit_at_angle(problem, theta), holding_change(problem, 0.0)
    rise, square = held_product(problem, a, j), held_product(problem, j, j)
    return rise / square if rise > 0.0 else 0.0


@inlined
def wrap_angle(angle: float) -> float:
    """Return a difference of angles, -pi to pi."""
    return angle - 2.0 * pi * round(angle / (2.0 * pi)) if abs(angle) > pi else angle
