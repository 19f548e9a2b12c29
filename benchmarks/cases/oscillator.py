"""Vibration with Coulomb friction in one dimension, forced and free."""

from __future__ import annotations

from functools import partial
from math import atan, pi, sqrt, tan

import numpy as np

import stiction as st
from benchmarks.cases.case import Case, block, crest
from stiction.reproduction.numbers import Number

SAMPLES = 20_000  # a period


def den_hartog(r: float, S: float, wanted: float, rtol: float) -> list[Number]:
    """Forced vibration without stops: x_0 k/P_0 = sqrt(U^2 - (S W)^2).

    U = 1/(1 - r^2), W = tan(pi/2r)/r, S = F/P_0. With x = d - u, what has been slid, Eq. (1) is
    m x'' + k x = m d'' + k d - F sign(x'): the drive d = amplitude cos(omega t) acts as the force
    P_0 cos(omega t), P_0 = (k - m omega^2) times its amplitude.
    """
    amplitude = 1 / (1 - r * r)
    swinging = st.protocols.DriveProgram(
        along=st.protocols.Modulation(-amplitude * r, r / (2 * pi))
    )
    slider = block(friction=st.Coulomb(mu_0=S), drive=swinging)
    period = 2 * pi / r
    settled = st.simulate(slider, 100 * period, sample_rate=0, rtol=rtol)
    last = st.simulate(
        slider,
        period,
        initial=settled.state(100 * period),
        sample_rate=SAMPLES / period,
        rtol=rtol,
    )
    x = amplitude * np.cos(r * last.data["time"].values) - last.data["u_x"].values
    exact = sqrt(amplitude**2 - (S * tan(pi / (2 * r)) / r) ** 2)
    where = "Den Hartog 1931"
    return [
        Number(where, "amplitude x_0 k/P_0 as printed", wanted, crest(x), 5e-8),
        Number(where, "  in closed form", exact, crest(x), 1e-8),
        Number(where, "  on the other side", exact, crest(-x), 1e-8),
        Number(where, "stops in a period", 0, len(last.stick_intervals), 0),
    ]


def free(rtol: float) -> list[Number]:
    """x'' + x = -sign(x'), x(0) = 12, x'(0) = 6: half circles about -1 and 1, until |x| < 1."""
    slider = block(friction=st.Coulomb(mu_0=1.0), drive=st.ConstantVelocity(0.0))
    start = st.Initial(u_x=12.0, v_x=6.0, v_y=0.0)
    first, radius = atan(6 / 13), sqrt(13**2 + 6**2) - 1
    numbers = []
    for n in range(7):
        run = st.simulate(slider, first + n * pi, initial=start, sample_rate=0, rtol=rtol)
        turn = (-1) ** n * (radius - 2 * n)
        found = float(run.final["u_x"])
        numbers.append(Number("Siconos", f"turning point {n + 1}", turn, found, 5e-7))
    run = st.simulate(slider, 30.0, initial=start, sample_rate=0, rtol=rtol)
    rest = float(run.stick_intervals[0, 0])
    return [
        *numbers,
        Number("Siconos", "at rest from", first + 7 * pi, rest, 5e-7),
        Number("Siconos", "  as printed", 22.42356, rest, 5e-6),
        Number("Siconos", "  at", 14 - radius, float(run.final["u_x"]), 5e-7),
        Number("Siconos", "  as printed", 0.682179, float(run.final["u_x"]), 5e-7),
        Number("Siconos", "stops", 1, len(run.stick_intervals), 0),
    ]


DEN_HARTOG = ((0.7, 0.2, 1.9277745), (1.5, 0.3, 0.7211103), (2.0, 0.4, 0.2666667))
CASES = (
    *(
        Case(f"forced vibration, r = {r:g}, S = {S:g}", partial(den_hartog, r, S, wanted))
        for r, S, wanted in DEN_HARTOG
    ),
    Case("free vibration", free),
)
