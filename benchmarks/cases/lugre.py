"""LuGre block pulled by a spring: Canudas de Wit's example, as published with Exudyn."""

from __future__ import annotations

import stiction as st
from benchmarks.cases.case import Case, block
from stiction.reproduction.numbers import Number
from stiction.solver.integrate import tolerance

V = 0.1  # m/s
RTOL = 1e-13  # where the digits are right


def pulled(rtol: float) -> list[Number]:
    """M = 1, K = 2: position, velocity and bristle at t = 25 s."""
    slider = block(
        k_x=2.0,
        k_y=2.0,
        friction=st.laws.LuGre(1.0, 1.5, 1e-3, 1e5, 1e5**0.5, 0.4),
        drive=st.ConstantVelocity(V),
        driven="spring",
    )
    start = st.Initial(v_x=V, v_y=0.0)
    end = st.simulate(slider, 25.0, sample_rate=0, initial=start, rtol=rtol).final
    # below 3 % of V an error of the slip is absolute, and the next step sees half of it
    below = 2.0 * 0.03 * V * tolerance(RTOL)
    return [
        Number("Exudyn", "x(25 s)", 1.9088391992, float(end["X"]), 5e-11, "m"),
        Number("Exudyn", "v(25 s)", 9.42415459e-6, float(end["V_X"]), 5e-15 + below, "m/s"),
        Number("Exudyn", "z(25 s)", 1.18167955e-5, float(end["z_x"]), 5e-14, "m"),
    ]


CASES = (Case("LuGre block pulled by a spring", pulled, RTOL),)
