"""SciPy's odeint on (mu, theta) with a right-hand side in Python, as rsfmodel solves.

rsfmodel itself (J. R. Leeman, github.com/jrleeman/rsfmodel) is in no package registry. Its
tolerances are 1e-12 by default; it looks up the drive velocity at each call, which this does not.
"""

from __future__ import annotations

from math import exp, log

import numpy as np
from scipy.integrate import odeint

from benchmarks.harness.contestant import Contestant
from benchmarks.state_laws.cases import AGEING, Case, Floats, RateState, in_pieces
from benchmarks.state_laws.peers import rows
from benchmarks.state_laws.settings import ODEINT


def contestants() -> list[Contestant]:
    """Return the rows of odeint, of the quasi-static cases."""
    return rows("odeint, as rsfmodel", solve, ODEINT)


def solve(case: Case, times: Floats, rtol: float, atol: float) -> Floats:
    """Solve a quasi-static case; the unknowns of `cases` are turned into (mu, theta) and back."""
    assert isinstance(case.law, RateState)
    a, b, D, mu_star, V_star = case.law

    def advance(y, t, p):
        k, v_d = p[5], p[7]

        def slope(w, t):
            mu, theta = w
            V = V_star * exp((mu - mu_star - b * log(V_star * theta / D)) / a)
            wear = V * theta / D
            return k * (v_d - V), 1.0 - wear if case.kind == AGEING else -wear * log(wear)

        start = mu_star + a * y[0] + b * y[1], D / V_star * exp(y[1])
        mu, theta = odeint(slope, start, t, rtol=rtol, atol=atol, mxstep=1_000_000).T
        state = np.log(V_star * theta / D)
        return np.stack([(mu - mu_star - b * state) / a, state], axis=1)

    return in_pieces(case, times, advance)
