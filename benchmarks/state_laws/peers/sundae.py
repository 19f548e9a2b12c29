"""CVODE of SUNDIALS through scikit-sundae: right-hand side and Jacobian compiled."""

from __future__ import annotations

from importlib import import_module

import numpy as np

from benchmarks.harness.contestant import Contestant, Failed
from benchmarks.state_laws.cases import Case, Floats, in_pieces
from benchmarks.state_laws.equations import MODELS
from benchmarks.state_laws.peers import rows
from benchmarks.state_laws.settings import CVODE

MOST_STEPS = 1_000_000


def contestants() -> list[Contestant]:
    """Return the rows of CVODE."""
    import_module("sksundae")  # its absence is to be noticed here

    return rows("CVODE (scikit-sundae)", solve, CVODE)


def solve(case: Case, times: Floats, rtol: float, atol: float) -> Floats:
    """Solve a case."""
    from sksundae.cvode import CVODE as Solver

    derivative, jacobian = MODELS[case.model]

    def advance(y, t, p):
        solver = Solver(
            lambda t, y, out: derivative(t, y, p, out),
            jacfn=lambda t, y, _, out: jacobian(t, y, p, out),
            rtol=rtol,
            atol=atol,
            max_num_steps=MOST_STEPS,
        )
        solution = solver.solve(t, y)
        if not solution.success:
            raise Failed(str(solution.message))
        # two times mean every step
        return np.asarray(solution.y)[[0, -1] if len(t) == 2 else slice(None)]

    return in_pieces(case, times, advance)
