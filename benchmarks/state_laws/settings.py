"""Tolerances of the peers: from loose to just above what the reference is worth.

An absolute one of 1 to 1e-4 times the other hardly matters: unknowns are of order one.
In Fig. 3 the unknowns are metres and m/s, and delta must be resolved.
"""

from __future__ import annotations

from benchmarks.state_laws.cases import Case, RateState, Smoothing

Settings = list[dict[str, float]]


def pairs(rtols: tuple[float, ...], share: float) -> Settings:
    """Return settings with an absolute tolerance of a share of the relative one."""
    return [{"rtol": rtol, "atol": rtol * share} for rtol in rtols]


def LSODA(case: Case) -> Settings:
    """Return those of LSODA through numbalsoda."""
    if isinstance(case.law, Smoothing):
        return pairs((1e-5, 1e-6, 1e-7, 1e-9), 1e4 * case.law.delta)
    return pairs((1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9), 0.1)


def CVODE(case: Case) -> Settings:
    """Return those of CVODE, which needs a second for Fig. 3 and more for a smaller delta."""
    if isinstance(case.law, Smoothing):
        return pairs((1e-6,), 1e-3) if case.law.delta > 1e-8 else []
    return pairs((1e-4, 1e-6, 1e-8, 1e-9), 0.1)


def RADAU(case: Case) -> Settings:
    """Return those of Radau; Fig. 3 takes it minutes."""
    return [] if isinstance(case.law, Smoothing) else pairs((1e-4, 1e-6), 0.1)


def ODEINT(case: Case) -> Settings:
    """Return those of odeint as rsfmodel calls it; its own are 1e-12."""
    quasi_static = isinstance(case.law, RateState) and case.mass == 0.0
    return pairs((1e-6, 1e-9, 1e-12), 1.0) if quasi_static else []
