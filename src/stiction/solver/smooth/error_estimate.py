"""The collocation cubic inside a step: its error, also where friction is stiff.

The cubic through the start and the stages misses the equations by a defect, which goes as
pi(c) = (c - c_1)(c - c_2)(c - 1); so its error goes as the integral of pi. Where friction
or a state is stiff the error is less, as an implicit step from the cubic shows (M70).
"""

from __future__ import annotations

from math import inf, sqrt
from typing import NamedTuple

from numpy.polynomial import Polynomial

from stiction.friction.law import Vector
from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import inlined
from stiction.solver.problem import Problem
from stiction.solver.smooth.coordinate import coordinate, slip_at
from stiction.solver.smooth.elimination import correct_states_inside, slip_without_states
from stiction.solver.smooth.newton import CLOSEST, DIVERGED, correct, larger
from stiction.solver.smooth.right_hand_side import (
    SmoothOutset,
    evaluate,
    inertia_share,
    pull,
    slowest,
)
from stiction.solver.smooth.workspace import INSIDE, START, WANTED, Workspace
from stiction.solver.stepping.radau import (
    DEFECT_WEIGHT,
    INTERIOR,
    C,
    cubic,
    cubic_slope,
    integral,
    leading_factor,
)

BALANCE_ITERATIONS = 20
COARSE = 0.1  # relative correction: the error needs one digit
# how the error goes inside a step, 1 in magnitude at c_1, where it is largest
_PI = Polynomial.fromroots(C).integ()
LARGEST_INTEGRAL = float(
    abs(_PI(C[0]))
)  # integral of the cubic less the quadratic, over the factor of c^3
ERROR = tuple(float(x) for x in (_PI / LARGEST_INTEGRAL).coef[1:])


class Within(NamedTuple):
    """The collocation polynomials of slip at a point of a step.

    Value (m/s), its derivative times h, and the distance slid over h.
    """

    s_x: float
    s_y: float
    d_x: float
    d_y: float
    slid_x: float
    slid_y: float


class Balanced(NamedTuple):
    """The slip velocity (m/s) that balances the forces at a point of a step, and its validity.

    `slower` is the decrease of this velocity if the mass had slid further, `rounding` a bound of
    its part that is due to the rounding of forces.
    """

    found: bool
    slip: Vector
    slower: Vector
    rounding: float


@inlined
def within(w: Workspace, c: float) -> Within:
    """Return the polynomials of slip at `c`; write those of the states."""
    v = w.values
    x0, x1, x2, x3 = v[START, 0], v[1, 0], v[2, 0], v[3, 0]
    y0, y1, y2, y3 = v[START, 1], v[1, 1], v[2, 1], v[3, 1]
    for k in range(2, w.size.shape[0]):
        z = v[START, k], v[1, k], v[2, k], v[3, k]
        w.cubic[0, k], w.cubic[1, k] = cubic(z, c), cubic_slope(z, c)
    return Within(
        cubic((x0, x1, x2, x3), c),
        cubic((y0, y1, y2, y3), c),
        cubic_slope((x0, x1, x2, x3), c),
        cubic_slope((y0, y1, y2, y3), c),
        integral((x1, x2, x3), c),
        integral((y1, y2, y3), c),
    )


@inlined
def less_error(w: Workspace, p: Within, c: float) -> Within:
    """Return the polynomials of slip at `c` less their estimated error; keep the distance slid."""
    e1, e2, e3, e4 = ERROR
    shape = c * (e1 + c * (e2 + c * (e3 + c * e4)))
    slope = e1 + c * (2.0 * e2 + c * (3.0 * e3 + c * 4.0 * e4))
    for k in range(2, w.size.shape[0]):
        w.cubic[0, k] -= w.error[k] * shape
        w.cubic[1, k] -= w.error[k] * slope
    x, y = w.error[0], w.error[1]
    return Within(
        p.s_x - x * shape,
        p.s_y - y * shape,
        p.d_x - x * slope,
        p.d_y - y * slope,
        p.slid_x,
        p.slid_y,
    )


@inlined
def balance(
    problem: Problem,
    start: SmoothOutset,
    h: float,
    c: float,
    weight: float,
    p: Within,
    w: Workspace,
    enough: float,
    further: Vector,
) -> Balanced:
    """Solve for slip and states at `c` in the step; write the states to the row `INSIDE`.

    They are x with x - p + weight (p' - h f(x)) = 0 (M70), p being the polynomial and f the
    right-hand side. Where f is gentle, x is p up to its error; where it is stiff, forces balance.
    By so much slower (m/s) would the slip be, had the mass slid `further` (over h).
    """
    n, system, eps = w.size.shape[0], problem.system, start.eps
    a_x, a_y, load = pull(problem, start, c * h)
    a_x -= system.k_x * system.per_mass * h * p.slid_x
    a_y -= system.k_y * system.per_mass * h * p.slid_y
    q_x, q_y = coordinate(eps, p.s_x, p.s_y)
    for k in range(2, n):
        w.values[INSIDE, k] = w.cubic[0, k]
    g = weight * h
    damping_x, damping_y = g * system.c_x * system.per_mass, g * system.c_y * system.per_mass
    given_x, given_y = p.s_x - weight * p.d_x + g * a_x, p.s_y - weight * p.d_y + g * a_y
    x, y = 1.0 + damping_x, 1.0 + damping_y
    at = evaluate(problem, eps, load, q_x, q_y, w, INSIDE, WANTED)
    square = g * h * system.per_mass
    lost_x, lost_y = square * system.k_x * further[0], square * system.k_y * further[1]
    for _ in range(BALANCE_ITERATIONS):
        r_x, r_y = x * at.s_x + g * at.f_x - given_x, y * at.s_y + g * at.f_y - given_y
        xx, xy = x * at.s_xx + g * at.f_xx, x * at.s_xy + g * at.f_xy
        yx, yy = y * at.s_xy + g * at.f_yx, y * at.s_yy + g * at.f_yy
        if n > 2:
            xx, xy, yx, yy, r_x, r_y = slip_without_states(
                g, weight, at, (xx, xy, yx, yy, r_x, r_y), w
            )
        per = 1.0 / (xx * yy - xy * yx)
        d_x, d_y = (yy * r_x - xy * r_y) * per, (xx * r_y - yx * r_x) * per
        share = 1.0
        if eps < inf:
            mixed = 0.5 * (at.f_xy + at.f_yx)
            slope, friction = (at.s_xx, at.s_xy, at.s_yy), (at.f_xx, mixed, at.f_yy)
            share = inertia_share(problem, g, 1.0, (q_x, q_y), slope, friction)
        q_x, q_y, _, size = correct(start, share, w.size[0], q_x, q_y, d_x, d_y)
        if n > 2:
            size = larger(correct_states_inside(d_x, d_y, w), size)
        if not size < DIVERGED:
            break
        by_x = abs(at.s_xx * yy - at.s_xy * yx) + abs(at.s_xy * yy - at.s_yy * yx)
        by_y = abs(at.s_xy * xx - at.s_xx * xy) + abs(at.s_yy * xx - at.s_xy * xy)
        rounding = CLOSEST * abs(g * per) * (by_x * abs(a_x) + by_y * abs(a_y))
        lost_in_rounding = eps == inf and sqrt(d_x * d_x + d_y * d_y) < rounding
        if size < enough or size * size < enough or lost_in_rounding:
            d_x, d_y = (yy * lost_x - xy * lost_y) * per, (xx * lost_y - yx * lost_x) * per
            slower = at.s_xx * d_x + at.s_xy * d_y, at.s_xy * d_x + at.s_yy * d_y
            return Balanced(True, slip_at(eps, q_x, q_y), slower, rounding)
        at = evaluate(problem, eps, load, q_x, q_y, w, INSIDE, WANTED)
    return Balanced(False, (at.s_x, at.s_y), (0.0, 0.0), 0.0)


@inlined
def distance_error(w: Workspace) -> tuple[float, float]:
    """Return the largest error of the distance slid inside the step, over h (m/s), from c_1.

    The distance is the integral of the quadratic through the stages, the slip is the cubic. The
    sign is reversed, as (M70) reverses that of the error at c_1.
    """
    v = w.values
    x = leading_factor((v[START, 0], v[1, 0], v[2, 0], v[3, 0]))
    y = leading_factor((v[START, 1], v[1, 1], v[2, 1], v[3, 1]))
    return LARGEST_INTEGRAL * x, LARGEST_INTEGRAL * y


@inlined
def local_error(
    problem: Problem, start: SmoothOutset, h: float, w: Workspace, accuracy: Accuracy
) -> float:
    """Return the relative error of the step's cubic; write the error itself.

    It is relative to the slip, or to the motion about steady sliding if that is slower; slip that
    the rounding of forces makes is not an error (M70c). Where slip follows the springs, the cubic
    misses no force, and its error is that of the distance (M70b).
    """
    p = within(w, INTERIOR)
    found, (s_x, s_y), (by_x, by_y), rounding = balance(
        problem, start, h, INTERIOR, DEFECT_WEIGHT, p, w, COARSE, distance_error(w)
    )
    if not found:
        return inf
    e_x, e_y = p.s_x - s_x, p.s_y - s_y
    w.error[0], w.error[1] = e_x, e_y
    speed = slowest(h, w, accuracy.speed) + sqrt(s_x * s_x + s_y * s_y)
    speed = max(speed, rounding / accuracy.tolerance)
    x, y = e_x + by_x, e_y + by_y
    error = sqrt(max(e_x * e_x + e_y * e_y, x * x + y * y)) / speed
    for k in range(2, w.size.shape[0]):
        w.error[k] = w.cubic[0, k] - w.values[INSIDE, k]
        error = max(error, abs(w.error[k]) / w.size[k])
    return error / start.share
