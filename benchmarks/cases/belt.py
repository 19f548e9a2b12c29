"""Stick-slip of a block on a belt: Leine et al., Nonlinear Dynamics 16 (1998)."""

from __future__ import annotations

from functools import cache

from scipy.integrate import solve_ivp

from benchmarks.cases.case import Case
from benchmarks.cases.published import published_cases
from stiction.presets import Number, find

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

    vars(landed).update(terminal=True, direction=-1.0)
    vars(fastest).update(direction=1.0)
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
    """The preset `leine-belt`, beside SciPy."""
    found = published_cases(find("leine-belt"), rtol)
    slip, stick, _, highest, lowest, _ = (number.computed for number in found)
    names = ("length of a slip", "length of a stick", "largest u", "smallest du/dt")
    values = zip(
        names, by_scipy(), (slip, stick, highest, lowest), ("s", "s", "m", "m/s"), strict=True
    )
    return [
        Number("SciPy, DOP853", name, sharp, value, 1e-8, unit)
        for name, sharp, value, unit in values
    ]


CASES = (Case("block on a belt, beside SciPy", belt),)
