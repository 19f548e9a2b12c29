"""Active control of friction: a rigid slider shaken across its way."""

from __future__ import annotations

from functools import partial
from math import pi, sqrt

from scipy.special import ellipk

import stiction as st
from benchmarks.cases.case import Case, block
from stiction.reproduction.numbers import Number

MU = 0.3


def shaken(r: float, wanted: float, rtol: float) -> list[Number]:
    """Mean friction along X over mu_0 W is (2/pi) K(-r^2), for a slider that follows the drive.

    Simulated, not in the rigid limit: springs so stiff that the mass lags by 1e-6 of the travel,
    critically damped; the mean over a period of what the spring feels.
    """
    k = 1e6 * (2 * pi) ** 2
    slider = block(
        k_x=k,
        k_y=k,
        c_x=2 * sqrt(k),
        c_y=2 * sqrt(k),
        friction=st.Coulomb(MU),
        drive=st.protocols.DriveProgram(velocity=1.0, across=st.protocols.Modulation(r, 1.0)),
    )
    run = st.simulate(slider, 3.0, sample_rate=2000.0, rtol=rtol)
    last = run.data.isel(time=slice(-2000, None))  # a whole period: the damper's part is nought
    mean = float(last["spring_x"].mean()) / MU
    return [
        Number("elliptic integral", "mean friction/mu_0 W, as printed", wanted, mean, 5e-6),
        Number("elliptic integral", "  rigid limit", 2 / pi * float(ellipk(-r * r)), mean, 5e-6),
    ]


CASES = tuple(
    Case(f"transverse oscillation, r = {r:g}", partial(shaken, r, wanted), 1e-8)
    for r, wanted in ((1.0, 0.83463), (2.0, 0.64264), (10.0, 0.23442))
)
