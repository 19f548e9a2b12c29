"""LSODA and DOP853 of numbalsoda: C++ with a compiled right-hand side, no Python between steps."""

from __future__ import annotations

import numba
import numpy as np

from benchmarks.harness.contestant import Contestant, Failed, rows
from benchmarks.precision.case import PHI, drive, initial_state
from benchmarks.precision.equations import rates

# Ever sharper, the fastest found for what they reach, by trying hundreds with the answer known.
# From delta=9e-7 on the smoothed law damps the transverse oscillation away, and steps are long.
LSODA = (
    {"delta": 2e-6, "rtol": 1e-3, "atol": 3e-9},
    {"delta": 1.2e-6, "rtol": 3e-5, "atol": 1e-8},
    {"delta": 9e-7, "rtol": 1e-6, "atol": 1e-8},
    {"delta": 5e-7, "rtol": 1e-5, "atol": 3e-8},
    {"delta": 2e-7, "rtol": 1e-5, "atol": 1e-8},
    {"delta": 1e-7, "rtol": 1e-6, "atol": 1e-9},
    {"delta": 2e-10, "rtol": 1e-7, "atol": 1e-10},
    {"delta": 1e-12, "rtol": 1e-7, "atol": 1e-13},
    {"delta": 1e-14, "rtol": 1e-9, "atol": 1e-15},
    {"delta": 5e-15, "rtol": 2e-10, "atol": 1e-15},
    {"delta": 5e-15, "rtol": 1e-10, "atol": 1e-16},  # gives up here, not everywhere
)
DOP853 = (
    {"delta": 1e-6, "rtol": 1e-6, "atol": 1e-9},
    {"delta": 1e-7, "rtol": 1e-6, "atol": 1e-9},
)
MOST_STEPS = 5_000_000  # ten times what the sharpest needs; beyond this it is lost


def contestants() -> list[Contestant]:
    """Return the rows of both methods."""
    from numbalsoda import dop853, lsoda

    return [
        *rows("LSODA (numbalsoda)", solver(lsoda), LSODA),
        *rows("DOP853 (numbalsoda)", solver(dop853), DOP853),
    ]


def solver(method):
    """Return the function that solves by a method with the signature of numbalsoda's."""
    from numbalsoda import lsoda_sig

    @numba.cfunc(lsoda_sig)
    def right_hand_side(t, state, out, p):
        out[0], out[1], out[2], out[3] = rates(
            state[0], state[1], state[2], state[3], p[0], p[1], p[2]
        )

    def solve(times, *, delta, rtol, atol, phi=PHI):
        states, success = method(
            right_hand_side.address,
            initial_state(phi),
            times,
            np.array([*drive(phi), delta]),
            rtol,
            atol,
            MOST_STEPS,
        )
        if not success:  # the rest of `states` is then uninitialised memory
            raise Failed("gave up")
        return states[:, :2]

    return solve
