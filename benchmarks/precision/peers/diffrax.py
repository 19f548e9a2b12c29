"""Kvaerno3 and Kvaerno5 of diffrax: implicit Runge-Kutta methods compiled by JAX, in float64."""

from __future__ import annotations

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

KVAERNO3 = (
    {"delta": 3e-6, "rtol": 1e-3, "atol": 1e-8},
    {"delta": 1e-6, "rtol": 1e-4, "atol": 1e-8},
    {"delta": 1e-6, "rtol": 1e-5, "atol": 1e-9},
    {"delta": 1e-7, "rtol": 1e-5, "atol": 1e-9},
)
KVAERNO5 = (
    {"delta": 3e-6, "rtol": 1e-3, "atol": 1e-8},
    {"delta": 1e-6, "rtol": 1e-3, "atol": 1e-8},
)
MOST_STEPS = 5_000_000


def contestants() -> list[Contestant]:
    """Return the rows of both methods."""
    import diffrax

    return [
        *rows("Kvaerno5 (diffrax)", solver(diffrax.Kvaerno5()), KVAERNO5),
        *rows("Kvaerno3 (diffrax)", solver(diffrax.Kvaerno3()), KVAERNO3),
    ]


def solver(method):
    """Return the function that solves by a method."""
    run = jit_method(method)

    def solve(times, *, delta, rtol, atol, phi=PHI):
        found, success = run(times, initial_state(phi), (*drive(phi), delta), rtol, atol)
        if not success:
            raise Failed("gave up")
        return np.asarray(found)

    return solve


def rates(t, state, parameters):
    """Right-hand side of the regularised law in the state ``(u_x, u_y, s_x, s_y)``."""
    import jax.numpy as jnp

    v_x, v_y, delta = parameters
    u_x, u_y, s_x, s_y = state
    length = jnp.sqrt(s_x * s_x + s_y * s_y + delta * delta)
    pull = (MU_INF + (MU_0 - MU_INF) * jnp.exp(-length / V_F)) * W / (MASS * length)
    return jnp.stack(
        [v_x - s_x, v_y - s_y, K_X / MASS * u_x - pull * s_x, K_Y / MASS * u_y - pull * s_y]
    )


def jit_method(method):
    """Return ``(times, state, parameters, rtol, atol) -> (elongations, success)``, compiled."""
    import diffrax
    import jax

    jax.config.update("jax_enable_x64", True)

    @jax.jit
    def run(times, state, parameters, rtol, atol):
        solution = diffrax.diffeqsolve(
            diffrax.ODETerm(rates),
            method,
            times[0],
            times[-1],
            1e-9,
            state,
            parameters,
            saveat=diffrax.SaveAt(ts=times),
            stepsize_controller=diffrax.PIDController(rtol=rtol, atol=atol),
            max_steps=MOST_STEPS,
            throw=False,
        )
        return solution.ys[:, :2], solution.result == diffrax.RESULTS.successful

    return run
