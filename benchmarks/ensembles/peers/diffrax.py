"""Kvaerno3 and Kvaerno5 of diffrax under vmap: all runs step together, vectorised."""

from __future__ import annotations

import numpy as np

from benchmarks.ensembles.many import PHI
from benchmarks.harness.contestant import Contestant, Failed, rows
from benchmarks.precision.case import drive, initial_state
from benchmarks.precision.peers.diffrax import jit_method

KVAERNO3 = (
    {"delta": 3e-6, "rtol": 1e-3, "atol": 1e-8},
    {"delta": 1e-6, "rtol": 1e-3, "atol": 1e-8},
)
KVAERNO5 = ({"delta": 3e-6, "rtol": 1e-3, "atol": 1e-8},)


def contestants() -> list[Contestant]:
    """Return the rows of both methods."""
    import diffrax

    return [
        *rows("Kvaerno3 (diffrax), vmap", solver(diffrax.Kvaerno3()), KVAERNO3),
        *rows("Kvaerno5 (diffrax), vmap", solver(diffrax.Kvaerno5()), KVAERNO5),
    ]


def solver(method):
    """Return the function that solves by a method."""
    import jax

    run = jax.jit(jax.vmap(jit_method(method), in_axes=(None, 0, (0, 0, None), None, None)))
    states = np.array([initial_state(phi) for phi in PHI])
    v_x, v_y = np.array([drive(phi) for phi in PHI]).T

    def solve(times, *, delta, rtol, atol):
        found, success = run(times, states, (v_x, v_y, delta), rtol, atol)
        if not np.all(success):
            raise Failed("gave up")
        return np.asarray(found)

    return solve
