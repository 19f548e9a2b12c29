"""Stick-slip of a block on a belt: Leine et al., Nonlinear Dynamics 16 (1998)."""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.integrate import solve_ivp

import stiction as st
from benchmarks.cases.case import Case, block, crest
from stiction.reproduction.numbers import Number

SPEED, D = 0.2, 3.0  # of the belt; F = 1/(1 + d |slip|)


@cache
def by_scipy() -> tuple[float, float, float, float]:
    """Return the lengths of slip and stick, the largest u and the smallest du/dt, by DOP853.

    A slip begins where the spring takes all of the friction, u = 1 with the belt's speed, and ends
    where the slip is zero again: one smooth piece of an ordinary differential equation.
    """

    def change(t, y):
        return [y[1], 1.0 / (1.0 + D * (SPEED - y[1])) - y[0]]

    def landed(t, y):
        return SPEED - y[1]

    def turning(t, y):
        return y[1]

    def fastest(t, y):
        return change(t, y)[1]

    landed.terminal, landed.direction, fastest.direction = True, -1.0, 1.0
    # an ulp of slip to leave by: on the boundary itself the event would fire at once
    start = [1.0, SPEED * (1.0 - 1e-14)]
    found = solve_ivp(
        change,
        (0.0, 10.0),
        start,
        "DOP853",
        events=(landed, turning, fastest),
        rtol=1e-13,
        atol=1e-15,
    )
    slip, end = found.t_events[0][-1], found.y_events[0][-1]
    stick = (1.0 - end[0]) / SPEED
    return slip, stick, found.y_events[1][:, 0].max(), found.y_events[2][:, 1].min()


def belt(rtol: float) -> list[Number]:
    """k = m = F_s = 1, d = 3, belt speed 0.2: digits as published, and SciPy's."""
    law = st.laws.HyperbolicWeakening(mu_0=1.0, v_h=1 / D)
    slider = block(friction=law, drive=st.ConstantVelocity(SPEED))
    run = st.simulate(slider, 60.0, sample_rate=1e3, rtol=rtol)
    starts, ends = run.stick_intervals[1:-1].T  # whole ones, after a first cycle
    whole = slice(*np.searchsorted(run.data["time"].values, ends[[0, -1]]))
    computed = (
        float(np.mean(starts[1:] - ends[:-1])),
        float(np.mean(ends - starts)),
        crest(run.data["u_x"].values[whole]),
        -crest(-run.data["v_x"].values[whole]),
    )
    names = ("length of a slip", "length of a stick", "largest u", "smallest du/dt")
    units = ("s", "s", "m", "m/s")
    published = (4.296000, 7.705032, 1.133945, -0.839902)
    rows = zip(names, published, by_scipy(), computed, units, strict=True)
    numbers = []
    for name, printed, sharp, value, unit in rows:
        numbers.append(Number("Leine 1998", f"{name}, as printed", printed, value, 5.1e-7, unit))
        numbers.append(Number("SciPy, DOP853", f"{name}", sharp, value, 1e-8, unit))
    period = float(np.mean(np.diff(starts)))
    return [
        *numbers,
        Number("Leine 1998", "period, as printed", 12.001031, period, 5.1e-7, "s"),
        Number("Leine 1998", "whole sticks after the first, in 60 s", 4, len(starts), 0),
    ]


CASES = (Case("block on a belt", belt),)
