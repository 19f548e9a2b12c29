"""Steady sliding of the paper's apparatus: stable where the misalignment is large enough."""

from __future__ import annotations

from functools import cache
from math import degrees, nan, sqrt

import numpy as np
from scipy.optimize import brentq

import stiction as st
from benchmarks.cases.case import Case, growth
from stiction.presets import Number
from stiction.solver.accuracy import tolerance

LOW, HIGH = 8.0, 9.3  # deg
RATE = 1e3  # samples a second: some hundred in a period of the slow oscillation


@cache
def by_eigenvalues() -> float:
    """Return the misalignment (deg) at which an eigenvalue of the linearised system is imaginary.

    Friction acts on a small slip velocity beside that of the drive as the damping
    F'(V) n n^T + (F(V)/V) t t^T, n along the drive and t across it.
    """
    s = st.presets.nakano_popov_2020()
    V = s.motion.rate(0.0)[0]
    along = s.law.slope(V) * s.normal_load
    across = s.law.coefficient(V) * s.normal_load / V

    def largest(phi: float) -> float:
        c, n = np.cos(np.radians(phi)), np.sin(np.radians(phi))
        friction = along * np.outer([c, n], [c, n]) + across * np.outer([-n, c], [-n, c])
        upper = np.hstack([np.zeros((2, 2)), np.eye(2)])
        lower = np.hstack([-np.diag([s.k_x, s.k_y]), -friction]) / s.mass
        return float(np.linalg.eigvals(np.vstack([upper, lower])).real.max())

    return brentq(largest, LOW, HIGH, xtol=1e-12)


def growth_at(phi: float, rtol: float) -> float:
    """Return how fast a small oscillation about steady sliding grows (1/s), `phi` in deg.

    The transverse motion is damped away within milliseconds; what is left is of second order. The
    perturbation is of the size at which its square, which is left out, is a step's error.
    """
    slider = st.presets.nakano_popov_2020().replace(phi=f"{phi} deg")
    V, (c, n) = slider.motion.rate(0.0)[0], slider.direction
    F = slider.law.coefficient(V) * slider.normal_load
    v_x = sqrt(tolerance(rtol)) * V
    start = st.Initial(u_x=F * c / slider.k_x, u_y=F * n / slider.k_y, v_x=v_x, v_y=0.0)
    run = st.simulate(slider, 0.2, initial=start, sample_rate=RATE, rtol=rtol)
    return growth(run.data["v_x"].values[20:], RATE, 2)


def critical(rtol: float) -> list[Number]:
    """phi_c by simulation, beside the eigenvalues and tan^2 phi_c = -V F'(V)/F(V)."""
    s = st.presets.nakano_popov_2020()
    V = s.motion.rate(0.0)[0]
    rigid = degrees(np.arctan(np.sqrt(-V * s.law.slope(V) / s.law.coefficient(V))))
    found = nan
    if growth_at(LOW, rtol) > 0.0 > growth_at(HIGH, rtol):
        found = brentq(growth_at, LOW, HIGH, args=(rtol,), xtol=1e-9)
    return [
        Number("eigenvalues", "phi_c", by_eigenvalues(), found, 1e-4, "deg"),
        # that k_y is finite shifts it by some 1e-3 deg
        Number("k_y infinite", "phi_c", rigid, found, 2e-3, "deg"),
    ]


CASES = (Case("stability of steady sliding", critical, 1e-12),)
