"""Inside a step: the collocation cubic, its error, and what friction makes of it.

The cubic through the start and the stages misses the equations by a defect, which goes as
pi(c) = (c - c_1)(c - c_2)(c - 1); so its error goes as the integral of pi. Where friction
or a state is stiff the error is less, as an implicit step from the cubic shows (M69).
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import Polynomial

from stiction.solver import radau
from stiction.solver.compilation.jit import piece
from stiction.solver.problem import Problem
from stiction.solver.radau import DEFECT_WEIGHT, INTERIOR
from stiction.solver.smooth.coordinate import coordinate, slip_slope
from stiction.solver.smooth.linear import factorise, solve_in_place
from stiction.solver.smooth.newton import update
from stiction.solver.smooth.rates import Outset, evaluate, linearise, prepare, weigh
from stiction.solver.smooth.workspace import INSIDE, Workspace

ITERATIONS = 20
_C = np.array(radau.C)
# powers 1, 2, 3 of the cubic from values at the stages less that at the start
COEFFICIENTS = np.linalg.inv(_C[:, None] ** np.arange(1, 4))
# how the error goes inside a step, 1 in magnitude at c_1, where it is largest
_PI = Polynomial.fromroots(_C).integ()
ERROR = tuple(float(x) for x in (_PI / abs(_PI(radau.C[0]))).coef[1:])


@piece
def fit(w: Workspace) -> None:
    """Write the coefficients of the cubic through the step's start and stages."""
    for k in range(w.y.shape[1]):
        w.cubic[0, k] = w.values[0, k]
        for power in range(3):
            value = 0.0
            for i in range(3):
                value += COEFFICIENTS[power, i] * (w.values[i + 1, k] - w.values[0, k])
            w.cubic[power + 1, k] = value


@piece
def on_cubic(w: Workspace, k: int, c: float) -> tuple[float, float, float]:
    """Return value of a column at `c`, its derivative and its integral from 0, times h and 1/h.

    The estimated error is taken away from the cubic.
    """
    m, e = w.cubic, w.error[k]
    e1, e2, e3, e4 = ERROR[0] * e, ERROR[1] * e, ERROR[2] * e, ERROR[3] * e
    a0, a1, a2, a3 = m[0, k], m[1, k] - e1, m[2, k] - e2, m[3, k] - e3
    return (
        a0 + c * (a1 + c * (a2 + c * (a3 - c * e4))),
        a1 + c * (2.0 * a2 + c * (3.0 * a3 - c * 4.0 * e4)),
        c * (a0 + c * (a1 / 2.0 + c * (a2 / 3.0 + c * (a3 / 4.0 - c * e4 / 5.0)))),
    )


@piece
def balance(
    problem: Problem,
    start: Outset,
    h: float,
    c: float,
    weight: float,
    w: Workspace,
    enough: float,
) -> bool:
    """Solve for what friction and states are at `c` in the step, into the row `INSIDE`.

    That is x with x - p + weight (p' - h f(x)) = 0, p being the polynomial and f the equations:
    p itself up to its error where f is gentle, what balances where f is stiff.
    """
    n, s, i = w.y.shape[1], problem.system, INSIDE
    prepare(problem, start, c * h, w, i)
    for k in range(2):
        stiffness = s.k_x if k == 0 else s.k_y
        w.pull[i, k] -= stiffness * s.per_mass * h * on_cubic(w, k, c)[2]
    q = coordinate(start.eps, on_cubic(w, 0, c)[0], on_cubic(w, 1, c)[0])
    w.y[i, 0], w.y[i, 1] = q
    for k in range(2, n):
        w.y[i, k] = on_cubic(w, k, c)[0]
    g = weight * h
    for _ in range(ITERATIONS):
        evaluate(problem, start.eps, w, i)
        linearise(problem, start, w, i)
        weigh(problem, start, g, 1.0, w, i)
        xx, xy, yy = slip_slope(start.eps, w.y[i, 0], w.y[i, 1])
        x, y = 1.0 + g * s.c_x * s.per_mass, 1.0 + g * s.c_y * s.per_mass
        for k in range(n):
            p, dp, _ = on_cubic(w, k, c)
            if k < 2:
                damping = s.c_x if k == 0 else s.c_y
                rate = w.pull[i, k] - damping * s.per_mass * w.values[i, k] - w.flow[i, k]
            else:
                rate = w.flow[i, k]
            w.right[k] = w.values[i, k] - p + weight * (dp - h * rate)
            sign = g if k < 2 else -g
            for j in range(n):
                w.matrix[k, j] = sign * w.jacobian[i, k, j] + (1.0 if k == j and k > 1 else 0.0)
        w.matrix[0, 0] += x * xx
        w.matrix[0, 1] += x * xy
        w.matrix[1, 0] += y * xy
        w.matrix[1, 1] += y * yy
        if not factorise(w.matrix, w.order, w.scale, n):
            return False
        solve_in_place(w.matrix, w.order, w.right, n)
        size = update(w, start.unit, i, 0)
        if not size < 1e100:
            return False
        if size < enough or size * size < enough:
            evaluate(problem, start.eps, w, i)
            return True
    return False


@piece
def local_error(problem: Problem, start: Outset, h: float, w: Workspace, speed: float) -> float:
    """Return the relative error of the step's cubic, and write the error itself.

    Where the motion about steady sliding is slower than the slip, relative to that.
    """
    n = w.y.shape[1]
    fit(w)
    for k in range(n):
        w.error[k] = 0.0
    if not balance(problem, start, h, INTERIOR, DEFECT_WEIGHT, w, 0.1):
        return np.inf
    s_x, s_y = w.values[INSIDE, 0], w.values[INSIDE, 1]
    for k in range(n):
        w.error[k] = on_cubic(w, k, INTERIOR)[0] - w.values[INSIDE, k]
    e_x, e_y = w.error[0], w.error[1]
    error = np.sqrt(e_x * e_x + e_y * e_y) / (speed + np.sqrt(s_x * s_x + s_y * s_y))
    for k in range(2, n):
        error = max(error, abs(w.error[k]) / w.size[k])
    return float(error) / start.share
