"""Output samples inside a step; they do not influence the steps.

A row is that of `stiction.solver.exact.sampling`, then the internal states. It is the end of a
shorter step from the same start, as there.
"""

from __future__ import annotations

import numpy as np

from stiction.solver.compilation.jit import piece
from stiction.solver.exact.sampling import COLUMNS
from stiction.solver.problem import Problem, in_principal_axes, travel
from stiction.solver.radau import C
from stiction.solver.smooth.coordinate import coordinate
from stiction.solver.smooth.inside import balance, on_cubic
from stiction.solver.smooth.newton import A, solve
from stiction.solver.smooth.rates import Outset
from stiction.solver.smooth.workspace import INSIDE, START, Workspace
from stiction.solver.state import Accuracy

LAST = 3  # row of the last stage


@piece
def sample(
    problem: Problem,
    start: Outset,
    h: float,
    w: Workspace,
    inner: Workspace,
    accuracy: Accuracy,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
) -> int:
    """Fill the samples of an accepted step; return the next index."""
    while k < len(times) and times[k] <= start.t + h:
        dt = min(times[k] - start.t, h)
        x = dt / h
        d_x, d_y = in_principal_axes(problem, travel(problem.drive, start.t, dt))
        if dt > 0.0 and shorter(problem, start, x, h, w, inner, accuracy):
            slid_x = slid_y = 0.0
            for j in range(3):
                slid_x += dt * A[2, j] * inner.values[j + 1, 0]
                slid_y += dt * A[2, j] * inner.values[j + 1, 1]
            write(
                problem, start.u_x + d_x - slid_x, start.u_y + d_y - slid_y, inner, LAST, samples, k
            )
        else:  # the weight grows from zero at the start: there the polynomial is right
            balance(problem, start, h, x, x, w, accuracy.newton)
            u_x = start.u_x + d_x - h * on_cubic(w, 0, x)[2]
            u_y = start.u_y + d_y - h * on_cubic(w, 1, x)[2]
            write(problem, u_x, u_y, w, INSIDE, samples, k)
        k += 1
    return k


@piece
def shorter(
    problem: Problem,
    start: Outset,
    x: float,
    h: float,
    w: Workspace,
    inner: Workspace,
    accuracy: Accuracy,
) -> bool:
    """Solve the first part x of a step by itself, into `inner`; return whether it converges."""
    n = w.y.shape[1]
    for k in range(n):
        inner.size[k] = w.size[k]
        inner.values[START, k] = w.values[START, k]
        inner.y[START, k] = w.y[START, k]
    for i in range(3):
        c = C[i] * x
        inner.y[i + 1, 0], inner.y[i + 1, 1] = coordinate(
            start.eps, on_cubic(w, 0, c)[0], on_cubic(w, 1, c)[0]
        )
        for k in range(2, n):
            inner.y[i + 1, k] = on_cubic(w, k, c)[0]
    return bool(solve(problem, start, x * h, inner, accuracy)[0])


@piece
def write(
    problem: Problem, u_x: float, u_y: float, w: Workspace, i: int, samples: np.ndarray, k: int
) -> None:
    """Write one row from the values in row `i`."""
    m = problem.system.mass
    samples[k, 0] = u_x
    samples[k, 1] = u_y
    samples[k, 2] = w.values[i, 0]
    samples[k, 3] = w.values[i, 1]
    samples[k, 4] = w.flow[i, 0] * m
    samples[k, 5] = w.flow[i, 1] * m
    samples[k, 6] = 0.0
    for j in range(2, w.y.shape[1]):
        samples[k, COLUMNS + j - 2] = w.values[i, j]
