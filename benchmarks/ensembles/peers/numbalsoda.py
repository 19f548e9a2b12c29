"""LSODA of numbalsoda in threads."""

from __future__ import annotations

import numba

from benchmarks.ensembles.many import in_threads
from benchmarks.harness.contestant import Contestant, rows
from benchmarks.precision.peers.numbalsoda import solver

LSODA = (
    {"delta": 3e-6, "rtol": 1e-4, "atol": 1e-8},
    {"delta": 1e-6, "rtol": 1e-6, "atol": 1e-8},
    {"delta": 1e-7, "rtol": 1e-6, "atol": 1e-9},
    {"delta": 2e-10, "rtol": 1e-7, "atol": 1e-10},
    {"delta": 1e-12, "rtol": 1e-7, "atol": 1e-13},
)


def contestants() -> list[Contestant]:
    """Return the rows of LSODA, which a wrapper without Python's lock calls."""
    from numbalsoda import lsoda

    @numba.njit(nogil=True)
    def unlocked(address, state, times, parameters, rtol, atol, mxstep):
        return lsoda(address, state, times, parameters, rtol, atol, mxstep)

    return rows("LSODA (numbalsoda), threads", in_threads(solver(unlocked)), LSODA)
