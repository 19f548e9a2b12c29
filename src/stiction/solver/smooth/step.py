"""One accepted step: prediction, collocation, error control."""

from __future__ import annotations

from stiction.solver.compilation.jit import piece
from stiction.solver.exact.step import ATTEMPTS, RESOLUTION
from stiction.solver.problem import Problem
from stiction.solver.radau import C, cubic, step_factor
from stiction.solver.smooth.coordinate import coordinate
from stiction.solver.smooth.inside import local_error
from stiction.solver.smooth.newton import solve
from stiction.solver.smooth.rates import Outset
from stiction.solver.smooth.workspace import START, Workspace
from stiction.solver.state import Accuracy


@piece
def predict(w: Workspace, x: float, warm: bool) -> None:
    """Write a first guess of the stages: the last step's unknowns, continued `x` steps of it."""
    n = w.y.shape[1]
    for i in range(3):
        for k in range(n):
            w.y[i + 1, k] = w.y[START, k]
            if warm:
                last = (w.past[0, k], w.past[1, k], w.past[2, k], w.past[3, k])
                w.y[i + 1, k] = cubic(last, 1.0 + C[i] * x)


@piece
def remember(w: Workspace, eps: float) -> None:
    """Turn the slip velocities of the last step into the slip coordinate of this one."""
    for i in range(4):
        w.past[i, 0], w.past[i, 1] = coordinate(eps, w.past[i, 0], w.past[i, 1])


@piece
def step(
    problem: Problem,
    start: Outset,
    t_stop: float,
    h: float,
    h_last: float,
    warm: bool,
    w: Workspace,
    accuracy: Accuracy,
) -> tuple[bool, float, float, int, int]:
    """Take one step; return (done, h, error over tolerance, rejected, iterations)."""
    rejected = iterations = 0
    for _ in range(ATTEMPTS):
        if start.t + h >= t_stop:
            h = t_stop - start.t
        elif not h > RESOLUTION * abs(start.t):
            break
        predict(w, h / h_last, warm)
        converged, count = solve(problem, start, h, w, accuracy)
        iterations += count
        factor = 0.3
        if converged:
            error = local_error(problem, start, h, w, accuracy.speed) / accuracy.tolerance
            if error <= 1.0:
                return True, h, error, rejected, iterations
            factor = step_factor(error, 1.0)
        rejected += 1
        h *= factor
    return False, h, 0.0, rejected, iterations
