"""The reference for errors: LSODA at its tightest, which shares nothing with our solver."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from benchmarks.harness.row import Errors
from benchmarks.state_laws.cases import Case, Floats

RTOL, SHARE = 1e-13, 1e-2  # the latter of the absolute tolerance over the relative one


class Reference(NamedTuple):
    """Force and state, (n, 2), and by how much LSODA at ten times the tolerance differs."""

    found: Floats
    looser: Errors


def reference(case: Case) -> Reference:
    """Compute the reference of a case: by numbalsoda, or by SciPy where that is not installed."""
    tight, loose = (solve(case, RTOL * factor) for factor in (1.0, 10.0))
    return Reference(tight, largest(loose, tight))


def solve(case: Case, rtol: float) -> Floats:
    """Solve by LSODA; the smallest absolute tolerance of Fig. 3 is that of delta."""
    try:
        from benchmarks.state_laws.peers.numbalsoda import solve as lsoda

        return lsoda(case, case.times, rtol, SHARE * rtol)
    except ImportError:
        from benchmarks.state_laws.peers.scipy import solve as slow

        return slow(case, case.times, rtol, SHARE * rtol, "LSODA")


def largest(found: Floats, known: Floats) -> Errors:
    """Return the largest errors of force and state."""
    return Errors(*map(float, np.abs(found - known).max(axis=0)))
