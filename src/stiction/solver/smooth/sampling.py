"""Output samples inside a step; they do not influence the steps.

A row is that of `stiction.solver.sampling`, then the internal states.
"""

from __future__ import annotations

import numpy as np

from stiction.solver.compiled import piece
from stiction.solver.problem import Problem, in_principal_axes, travel
from stiction.solver.sampling import COLUMNS
from stiction.solver.smooth.inside import balance, on_cubic
from stiction.solver.smooth.rates import Outset
from stiction.solver.smooth.workspace import INSIDE, Workspace


@piece
def sample(
    problem: Problem,
    start: Outset,
    h: float,
    w: Workspace,
    enough: float,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
) -> int:
    """Fill the samples of an accepted step; return the next index."""
    m = problem.system.mass
    while k < len(times) and times[k] <= start.t + h:
        dt = times[k] - start.t
        c = dt / h
        d_x, d_y = in_principal_axes(problem, travel(problem.drive, start.t, dt))
        # the weight grows from zero at the start: there, and at the end, the polynomial is right
        balance(problem, start, h, c, c, w, enough)
        samples[k, 0] = start.u_x + d_x - h * on_cubic(w, 0, c)[2]
        samples[k, 1] = start.u_y + d_y - h * on_cubic(w, 1, c)[2]
        samples[k, 2] = w.values[INSIDE, 0]
        samples[k, 3] = w.values[INSIDE, 1]
        samples[k, 4] = w.flow[INSIDE, 0] * m
        samples[k, 5] = w.flow[INSIDE, 1] * m
        samples[k, 6] = 0.0
        for i in range(2, w.y.shape[1]):
            samples[k, COLUMNS + i - 2] = w.values[INSIDE, i]
        k += 1
    return k
