"""Newton's method for the collocation equations of one step."""

from __future__ import annotations

from math import sqrt

import numpy as np

from stiction.solver import radau
from stiction.solver.compilation.jit import piece
from stiction.solver.problem import Problem
from stiction.solver.smooth.coordinate import risen, slip_slope
from stiction.solver.smooth.linear import factorise, solve_in_place
from stiction.solver.smooth.rates import Outset, evaluate, linearise, prepare, weigh
from stiction.solver.smooth.workspace import Workspace
from stiction.solver.state import Accuracy

ITERATIONS = 14
CLOSEST = 1e-14  # relative: corrections below are rounding
A, D, C = np.array(radau.A), np.array(radau.D), radau.C


@piece
def residuals(problem: Problem, h: float, w: Workspace) -> None:
    """Write the collocation equations' residuals (M66), (M67), a stage after the other."""
    n, s = w.y.shape[1], problem.system
    for i in range(3):
        for k in range(n):
            change = slid = 0.0
            for j in range(3):
                change += D[i, j] * (w.values[j + 1, k] - w.values[0, k])
                slid += A[i, j] * w.values[j + 1, k]
            if k < 2:
                stiffness, damping = (s.k_x, s.c_x) if k == 0 else (s.k_y, s.c_y)
                lost = (stiffness * h * slid + damping * w.values[i + 1, k]) * s.per_mass
                rate = w.pull[i + 1, k] - lost - w.flow[i + 1, k]
            else:
                rate = w.flow[i + 1, k]
            w.right[i * n + k] = change - h * rate


@piece
def assemble(problem: Problem, start: Outset, h: float, w: Workspace) -> bool:
    """Linearise the collocation equations; return whether they can be solved."""
    n, s = w.y.shape[1], problem.system
    for i in range(1, 4):
        linearise(problem, start, w, i)
        weigh(problem, start, h, D[i - 1, i - 1], w, i)
    for j in range(3):
        xx, xy, yy = slip_slope(start.eps, w.y[j + 1, 0], w.y[j + 1, 1])
        for i in range(3):
            row, column = i * n, j * n
            for k in range(n):
                w.matrix[row + k, column : column + n] = 0.0
            x = D[i, j] + h * h * s.k_x * s.per_mass * A[i, j]
            y = D[i, j] + h * h * s.k_y * s.per_mass * A[i, j]
            if i == j:
                x += h * s.c_x * s.per_mass
                y += h * s.c_y * s.per_mass
            w.matrix[row, column] = x * xx
            w.matrix[row, column + 1] = x * xy
            w.matrix[row + 1, column] = y * xy
            w.matrix[row + 1, column + 1] = y * yy
            for k in range(2, n):
                w.matrix[row + k, column + k] = D[i, j]
        for k in range(n):
            sign = h if k < 2 else -h
            for by in range(n):
                w.matrix[j * n + k, j * n + by] += sign * w.jacobian[j + 1, k, by]
    return factorise(w.matrix, w.order, w.scale, 3 * n)


@piece
def update(w: Workspace, unit: float, i: int, offset: int) -> float:
    """Take the solution at `offset` from the unknowns in row `i`; return its relative size."""
    y, d, n = w.y, w.right, w.y.shape[1]
    q = sqrt(y[i, 0] * y[i, 0] + y[i, 1] * y[i, 1])
    d_x, d_y = d[offset], d[offset + 1]
    size = sqrt(d_x * d_x + d_y * d_y) / min(1.0, unit + q)
    q_x, q_y = y[i, 0] - d_x, y[i, 1] - d_y
    to = sqrt(q_x * q_x + q_y * q_y)
    if to - q > 0.1:
        f = risen(q, to - q, w.share[i]) / to
        q_x, q_y = f * q_x, f * q_y
    y[i, 0], y[i, 1] = q_x, q_y
    for k in range(2, n):
        y[i, k] -= d[offset + k]
        size = max(size, abs(d[offset + k]) / w.size[k])
    return size


@piece
def solve(
    problem: Problem, start: Outset, h: float, w: Workspace, accuracy: Accuracy
) -> tuple[bool, int]:
    """Solve the collocation equations from the guess in the stages' rows.

    Returns
    -------
    converged, iterations

    Notes
    -----
    The first Jacobian is kept while it contracts. One iteration with a fresh one squares the
    (relative) error, hence the test on the first correction's square.
    """
    for i in range(1, 4):
        prepare(problem, start, C[i - 1] * h, w, i)
        evaluate(problem, start.eps, w, i)
    enough = max(min(accuracy.newton, 0.01 * accuracy.tolerance) * start.share, CLOSEST)
    last, fresh = 1.0, True
    n = w.y.shape[1]
    if not assemble(problem, start, h, w):
        return False, 0
    for iteration in range(1, ITERATIONS + 1):
        residuals(problem, h, w)
        solve_in_place(w.matrix, w.order, w.right, 3 * n)
        size = 0.0
        for i in range(1, 4):
            part = update(w, start.unit, i, (i - 1) * n)
            size = part if not part <= size else size
        if not size < 1e100:
            return False, iteration
        rate = size if fresh else size / last
        if size < enough or (size * rate < enough and rate < 1.0):
            for i in range(1, 4):
                evaluate(problem, start.eps, w, i)
            return True, iteration
        for i in range(1, 4):
            evaluate(problem, start.eps, w, i)
        fresh = rate > 0.1
        if fresh and not assemble(problem, start, h, w):
            return False, iteration
        last = size
    return False, ITERATIONS
