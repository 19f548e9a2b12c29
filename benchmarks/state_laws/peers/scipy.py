"""Radau of SciPy: right-hand side and Jacobian compiled, steps in Python."""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.harness.contestant import Contestant, Failed
from benchmarks.state_laws.cases import Case, Floats, in_pieces
from benchmarks.state_laws.equations import MODELS
from benchmarks.state_laws.peers import rows
from benchmarks.state_laws.settings import RADAU


def contestants() -> list[Contestant]:
    """Return the rows of Radau."""
    return rows("Radau (SciPy)", solve, RADAU)


def solve(case: Case, times: Floats, rtol: float, atol: float, method: str = "Radau") -> Floats:
    """Solve a case by one of SciPy's methods."""
    derivative, jacobian = MODELS[case.model]

    def advance(y, t, p):
        def right_hand_side(t, y):
            out = np.empty(len(y))
            derivative(t, y, p, out)
            return out

        def slopes(t, y):
            out = np.empty((len(y), len(y)))
            jacobian(t, y, p, out)
            return out

        implicit = {"jac": slopes} if method in ("Radau", "BDF", "LSODA") else {}
        solution = solve_ivp(
            right_hand_side, (t[0], t[-1]), y, method, t, rtol=rtol, atol=atol, **implicit
        )
        if not solution.success:
            raise Failed(solution.message)
        return solution.y.T

    return in_pieces(case, times, advance)
