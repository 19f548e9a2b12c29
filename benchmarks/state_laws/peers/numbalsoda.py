"""LSODA of numbalsoda: C++ with a compiled right-hand side, no Python between steps."""

from __future__ import annotations

from functools import cache
from importlib import import_module

import numba

from benchmarks.harness.contestant import Contestant, Failed
from benchmarks.state_laws.cases import Case, Floats, in_pieces
from benchmarks.state_laws.equations import MODELS
from benchmarks.state_laws.peers import rows
from benchmarks.state_laws.settings import LSODA

MOST_STEPS = 1_000_000


def contestants() -> list[Contestant]:
    """Return the rows of LSODA."""
    import_module("numbalsoda")  # its absence is to be noticed here

    return rows("LSODA (numbalsoda)", solve, LSODA)


def solve(case: Case, times: Floats, rtol: float, atol: float) -> Floats:
    """Solve a case."""
    from numbalsoda import lsoda

    right_hand_side = compile_model(case.model)

    def advance(y, t, p):
        states, success = lsoda(right_hand_side.address, y, t, p, rtol, atol, MOST_STEPS)
        if not success:  # the rest of `states` is then uninitialised memory
            raise Failed("gave up")
        return states

    return in_pieces(case, times, advance)


@cache
def compile_model(model: str):
    """Return the right-hand side of a model as LSODA takes it."""
    from numbalsoda import lsoda_sig

    derivative, _ = MODELS[model]

    @numba.cfunc(lsoda_sig)
    def right_hand_side(t, y, out, p):
        derivative(t, y, p, out)

    return right_hand_side
