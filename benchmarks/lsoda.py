"""LSODA on a regularised law, ``s/sqrt(|s|^2 + delta^2)``: the common way to such problems."""

from __future__ import annotations

import importlib.util
import warnings
from functools import partial

import numba
import numpy as np
from scipy.integrate import solve_ivp

from .contestant import Contestant, Failed, absent, on_times
from .problem import DURATION, initial_state, jacobian, rates

# (delta in m/s, rtol, atol), ever sharper: numbalsoda's last is about as far as it goes; SciPy's
# version is lost soon after the second, so that its last row shows a failure.
NUMBALSODA = (
    (1e-7, 1e-6, 1e-9),
    (2e-10, 1e-7, 1e-10),
    (1e-12, 1e-7, 1e-13),
    (1e-13, 1e-9, 1e-16),
)
SCIPY = ((1e-7, 1e-6, 1e-9), (1e-9, 1e-7, 1e-10), (1e-12, 1e-7, 1e-13))
MOST_STEPS = 5_000_000  # ten times what the sharpest needs; beyond this it is lost


def _text(delta: float, rtol: float, atol: float) -> str:
    return f"delta={delta:g}, rtol={rtol:g}, atol={atol:g}"


def of_numbalsoda() -> list[Contestant]:
    """LSODA in C++ with a compiled right-hand side: no Python between its steps."""
    solver = "LSODA (numbalsoda)"
    if importlib.util.find_spec("numbalsoda") is None:
        return [absent(solver, _text(*values)) for values in NUMBALSODA]
    from numbalsoda import lsoda, lsoda_sig

    @numba.cfunc(lsoda_sig)
    def right_hand_side(t, state, derivative, parameters):
        d_u_x, d_u_y, d_s_x, d_s_y = rates(state[0], state[1], state[2], state[3], parameters[0])
        derivative[0] = d_u_x
        derivative[1] = d_u_y
        derivative[2] = d_s_x
        derivative[3] = d_s_y

    def solve(times, delta, rtol, atol):
        states, success = lsoda(
            right_hand_side.address,
            initial_state(),
            times,
            np.array([delta]),
            rtol=rtol,
            atol=atol,
            mxstep=MOST_STEPS,
        )
        if not success:  # the rest of `states` is then uninitialised memory
            raise Failed("gave up")
        return states[:, :2]

    return _rows(solver, solve, NUMBALSODA)


@numba.njit
def _derivative(t, state, delta):
    return np.array(rates(state[0], state[1], state[2], state[3], delta))


@numba.njit
def _jacobian(t, state, delta):
    return jacobian(state[2], state[3], delta)


def of_scipy() -> list[Contestant]:
    """LSODA of SciPy: right-hand side and Jacobian compiled, steps in Python.

    The Jacobian is given because it makes it faster here.
    """

    def solve(times, delta, rtol, atol):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            solution = solve_ivp(
                _derivative,
                (0.0, DURATION),
                initial_state(),
                method="LSODA",
                t_eval=times,
                args=(delta,),
                jac=_jacobian,
                rtol=rtol,
                atol=atol,
            )
        if not solution.success:
            raise Failed(str(caught[-1].message) if caught else solution.message)
        return solution.y[:2].T

    return _rows("LSODA (SciPy solve_ivp)", solve, SCIPY)


def _rows(solver, solve, settings) -> list[Contestant]:
    return [
        on_times(solver, _text(d, r, a), partial(solve, delta=d, rtol=r, atol=a))
        for d, r, a in settings
    ]
