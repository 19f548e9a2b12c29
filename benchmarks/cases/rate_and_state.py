"""Critical stiffness of rate and state friction, with inertia: Rice & Ruina 1983."""

from __future__ import annotations

from functools import partial
from math import nan

from scipy.optimize import brentq

import stiction as st
from benchmarks.cases.case import Case, growth
from stiction.presets import Number
from stiction.presets.preset import on_a_line
from stiction.solver.accuracy import tolerance

A, B, D_C, V, SIGMA, MASS = 0.01, 0.015, 1e-5, 1e-2, 5e6, 1e3  # all per unit area


def growth_at(k: float, kind: type, rtol: float) -> float:
    """Return how fast a small perturbation of steady sliding grows at a stiffness (Pa/m), 1/s.

    The perturbed equations are of third order. The perturbation is of the size at which its square,
    which is left out, is about as large beside it as the error of a step.
    """
    law = kind(a=A, b=B, D_c=D_C, mu_star=0.6, V_star=1e-6)
    slider = on_a_line(
        mass=MASS,
        k_x=k,
        normal_load=SIGMA,
        friction=law,
        drive=st.ConstantVelocity(V),
    )
    start = st.Initial(u_x=law.coefficient(V) * SIGMA / k, v_x=tolerance(rtol) ** 0.4 * V, v_y=0.0)
    rate = 2e3
    run = st.simulate(slider, 0.05, initial=start, sample_rate=rate, rtol=rtol)
    return growth(run.data["v_x"].values, rate, 3)


def critical(kind: type, rtol: float) -> list[Number]:
    """k_c = (b - a) sigma/D_c [1 + m V^2/(a sigma D_c)]; NaN where no sign changes near it."""
    known = (B - A) * SIGMA / D_C * (1.0 + MASS * V**2 / (A * SIGMA * D_C))
    low, high = 0.8 * known, 1.2 * known
    found = nan
    if growth_at(low, kind, rtol) > 0.0 > growth_at(high, kind, rtol):
        found = brentq(growth_at, low, high, args=(kind, rtol), xtol=1e-9 * known)
    return [Number("Rice & Ruina 1983", "k_c", known, found, 1e-5 * known, "Pa/m")]


CASES = (
    Case("critical stiffness, ageing law", partial(critical, st.laws.RateStateAgeing), 1e-12),
    Case("critical stiffness, slip law", partial(critical, st.laws.RateStateSlip), 1e-12),
)
