"""The smoothed law F s/sqrt(|s|^2 + delta^2): its equations of motion, and one step solved.

The same collocation as for the exact law, in the axes (x, y).
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from stiction.solver.blocks import Factors, Triple, dot, eliminated, solved
from stiction.solver.compiled import inlined
from stiction.solver.frame import friction
from stiction.solver.newton import ITERATIONS
from stiction.solver.problem import Problem, in_principal_axes, travel
from stiction.solver.radau import A, C, D
from stiction.solver.state import Accuracy, Motion
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
    c_x, c_y = system.c_x * system.per_mass, system.c_y * system.per_mass
    square = s_x * s_x + s_y * s_y
    r = sqrt(square)
    rho = sqrt(square + delta * delta)
    f, gradient = friction(problem, start.t + dt, r)
    f /= rho
    # d(F s/rho)/ds = (F/rho) I + (F'/(r rho) - F/rho^3) s s^T
    outer = (gradient / (rho * r) if r > 0.0 else 0.0) - f / (rho * rho)
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
    kx = h * h * problem.system.k_x * problem.system.per_mass
    ky = h * h * problem.system.k_y * problem.system.per_mass
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
    accuracy: Accuracy,
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
        size /= accuracy.speed + sqrt(x[2] * x[2] + y[2] * y[2])
        if not size < 1e10 or (iteration > 3 and size > last):
            return False, x, y, iteration
        if size < 0.01 * accuracy.tolerance:
            return True, x, y, iteration
        last = size
    return False, x, y, ITERATIONS
