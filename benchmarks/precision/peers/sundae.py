"""CVODE of SUNDIALS through scikit-sundae: right-hand side and Jacobian compiled."""

from __future__ import annotations

import numpy as np

from benchmarks.harness.contestant import Contestant, Failed, rows
from benchmarks.precision.case import PHI, drive, initial_state
from benchmarks.precision.equations import derivative, jacobian

CVODE = (
    {"delta": 3e-6, "rtol": 1e-4, "atol": 1e-8},
    {"delta": 1e-6, "rtol": 1e-4, "atol": 1e-8},
    {"delta": 1e-6, "rtol": 1e-6, "atol": 1e-8},
    {"delta": 1e-7, "rtol": 1e-6, "atol": 1e-9},
)
MOST_STEPS = 5_000_000


def contestants() -> list[Contestant]:
    """Return the rows of CVODE."""
    from sksundae.cvode import CVODE as Solver

    def solve(times, *, delta, rtol, atol, phi=PHI):
        parameters = np.array([*drive(phi), delta])
        solver = Solver(
            lambda t, y, out: derivative(t, y, parameters, out),
            jacfn=lambda t, y, _, out: jacobian(t, y, parameters, out),
            rtol=rtol,
            atol=atol,
            max_num_steps=MOST_STEPS,
        )
        solution = solver.solve(times, initial_state(phi))
        if not solution.success:
            raise Failed(str(solution.message))
        # two times mean every step
        return np.asarray(solution.y)[[0, -1] if len(times) == 2 else slice(None), :2]

    return rows("CVODE (scikit-sundae)", solve, CVODE)
