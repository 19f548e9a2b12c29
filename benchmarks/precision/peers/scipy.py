"""LSODA, Radau and BDF of SciPy: right-hand side and Jacobian compiled, steps in Python."""

from __future__ import annotations

import warnings
from functools import partial

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.harness.contestant import Contestant, Failed, rows
from benchmarks.precision.case import PHI, drive, initial_state
from benchmarks.precision.equations import derivative_of, jacobian_of

LSODA = (
    {"delta": 3e-6, "rtol": 1e-4, "atol": 1e-8},
    {"delta": 1e-6, "rtol": 1e-6, "atol": 1e-8},
    {"delta": 1e-7, "rtol": 1e-6, "atol": 1e-9},
    {"delta": 1e-9, "rtol": 1e-7, "atol": 1e-10},
)
RADAU = (
    {"delta": 3e-6, "rtol": 1e-4, "atol": 1e-8},
    {"delta": 1e-6, "rtol": 1e-3, "atol": 1e-8},
)
BDF = (
    {"delta": 3e-6, "rtol": 1e-4, "atol": 1e-8},
    {"delta": 1e-6, "rtol": 1e-6, "atol": 1e-8},
)


def contestants() -> list[Contestant]:
    """Return the rows of the three methods."""
    return [
        *rows("LSODA (SciPy)", partial(solve, "LSODA"), LSODA),
        *rows("Radau (SciPy)", partial(solve, "Radau"), RADAU),
        *rows("BDF (SciPy)", partial(solve, "BDF"), BDF),
    ]


def solve(method, times, *, delta, rtol, atol, phi=PHI):
    """Solve with one of SciPy's methods; with the Jacobian, which makes each faster here."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        solution = solve_ivp(
            derivative_of,
            (0.0, times[-1]),
            initial_state(phi),
            method=method,
            t_eval=times,
            args=(np.array([*drive(phi), delta]),),
            jac=jacobian_of,
            rtol=rtol,
            atol=atol,
        )
    if not solution.success:
        raise Failed(str(caught[-1].message) if caught else solution.message)
    return solution.y[:2].T
