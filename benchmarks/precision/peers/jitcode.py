"""JiTCODE: right-hand side and Jacobian as C, compiled when it starts; steps by LSODA of SciPy."""

from __future__ import annotations

import warnings

import numpy as np

from benchmarks.harness.contestant import Contestant, Failed, rows
from benchmarks.precision.case import (
    K_X,
    K_Y,
    MASS,
    MU_0,
    MU_INF,
    PHI,
    V_F,
    W,
    drive,
    initial_state,
)

LSODA = (
    {"delta": 3e-6, "rtol": 1e-4, "atol": 1e-8},
    {"delta": 1e-6, "rtol": 1e-5, "atol": 1e-8},
    {"delta": 1e-7, "rtol": 1e-6, "atol": 1e-9},
    {"delta": 2e-10, "rtol": 1e-7, "atol": 1e-10},
)


def contestants() -> list[Contestant]:
    """Return the rows of JiTCODE."""
    ode = compile_system()

    def solve(times, *, delta, rtol, atol, phi=PHI):
        ode.set_parameters(*drive(phi), delta)
        ode.set_integrator("LSODA", rtol=rtol, atol=atol)
        ode.set_initial_value(initial_state(phi), 0.0)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                return np.array([ode.y[:2], *(ode.integrate(t)[:2] for t in times[1:])])
            except Exception as problem:
                reason = caught[-1].message if caught else problem
                raise Failed(str(reason).splitlines()[0]) from problem

    return rows("LSODA (JiTCODE)", solve, LSODA)


def compile_system():
    """Return the system of JiTCODE, compiled."""
    import symengine
    from jitcode import jitcode, y

    v_x, v_y, delta = parameters = symengine.symbols("v_x v_y delta")
    length = symengine.sqrt(y(2) ** 2 + y(3) ** 2 + delta**2)
    pull = (MU_INF + (MU_0 - MU_INF) * symengine.exp(-length / V_F)) * W / (MASS * length)
    rates = [
        v_x - y(2),
        v_y - y(3),
        K_X / MASS * y(0) - pull * y(2),
        K_Y / MASS * y(1) - pull * y(3),
    ]
    ode = jitcode(rates, n=4, control_pars=parameters, verbose=False, wants_jacobian=True)
    ode.compile_C()
    return ode
