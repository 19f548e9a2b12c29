"""A slider of rate-and-state friction on a spring, without inertia, after a step of the drive.

With the slip speed v = V e^y after a step to V, the state theta = theta_V e^psi, where theta_V is
that of steady sliding at V, and lengths in D_c, times in D_c/V:

    mu - mu_V = a y + b psi,   (a + g e^y) y' = (k D_c/W) (1 - e^y) - b psi',

where g = c V/W stands for a damper beside the spring (J. R. Rice & A. L. Ruina, J. Appl. Mech. 50,
343 (1983); L. A. Reinen & J. D. Weeks, J. Geophys. Res. 98, 15937 (1993)). On a rig of any
stiffness it begins with steady sliding at V_0: psi = -y = ln(V/V_0).
"""

from __future__ import annotations

from contextlib import suppress
from math import exp, expm1, log
from types import SimpleNamespace
from typing import Any, Literal, NamedTuple
from warnings import catch_warnings, simplefilter

import numpy as np

from stiction.arrays import Floats
from stiction.friction.laws.rate_and_state.common import Ageing, Slipping, Squaring

Law = Literal["slip", "ageing", "perrin"]

TOLERANCE = 1e-7  # of y and psi
APART = 1e-3  # of D_c, between two places of which the difference is the slope
# Rates: more take a slip that runs away, and an oscillation that is hardly damped
MOST_RATES = 3000
FASTEST = 30.0  # logarithm of the slip speed over V at which a slip has run away
YOUNGEST = -100.0  # logarithm of the state, in a trial step of one: none is so young


EVOLUTIONS: dict[Law, Any] = {"ageing": Ageing, "slip": Slipping, "perrin": Squaring}
AT_V = SimpleNamespace(V_star=1.0)  # of a law in these units, whose log_theta is psi


class SpringSlider(NamedTuple):
    """The conditions of a step of the drive: parameters that are not fitted."""

    ratio: float  # of the speeds after and before the step
    # k/W, 1/m, and c V/W, 1
    stiffness: float
    damping: float


class FrictionCourse(NamedTuple):
    """Spring force over load after a step, relative to steady sliding afterwards."""

    friction: Floats  # (n,), 1
    slope: Floats  # (n,), its change with the travel of the drive, 1/m


def course_after_a_step(
    rig: SpringSlider, law: Law, a: float, b: float, D_c: float, slip: Floats
) -> FrictionCourse | None:
    """Return the course of friction after a step; None if it slips away.

    The slip (n,) is the ascending travel of the drive since the step, m.
    """
    kappa = rig.stiffness * D_c
    # k (1 - v) would be the slope as well, but on a stiff rig it is that of rounded v
    times = np.concatenate([slip / D_c, slip / D_c + APART])
    order = np.argsort(times)
    found = _course(rig, law, a, b, kappa, times[order])
    if found is None:
        return None
    y, psi = found.T
    friction = np.empty(len(times))
    friction[order] = a * y + b * psi + rig.damping * np.expm1(y)
    now, later = np.split(friction, 2)
    return FrictionCourse(now, (later - now) / (APART * D_c))


def _first(rig: SpringSlider, a: float) -> float:
    """Return y just after the step: a damper takes up part of the jump, as the spring cannot."""
    from scipy.optimize import brentq

    low = -log(rig.ratio)
    if not rig.damping:
        return low
    solve: Any = brentq
    return float(solve(lambda y: a * (y - low) + rig.damping * expm1(y), *sorted((low, 0.0))))


def _course(
    rig: SpringSlider, law: Law, a: float, b: float, kappa: float, times: Floats
) -> Floats | None:
    """Return y and psi, (n, 2), at times from 0 on; None where the slip runs away."""
    from scipy.integrate import ODEintWarning, odeint

    ages, damping, left = EVOLUTIONS[law], rig.damping, MOST_RATES

    def rate(state: Floats, _: float) -> tuple[float, float]:
        nonlocal left
        y, psi = state.tolist()
        left -= 1
        if y > FASTEST or left < 0:
            raise ArithmeticError
        v = exp(y)
        change = ages.evolution(AT_V, max(psi, YOUNGEST), v, 1.0)
        return (kappa * (1.0 - v) - b * change) / (a + damping * v), change

    def jacobian(state: Floats, _: float) -> tuple[tuple[float, float], tuple[float, float]]:
        y, psi = state.tolist()
        v = exp(min(y, FASTEST))
        psi, held = max(psi, YOUNGEST), a + damping * v
        by_v, _, by_psi = ages.evolution_gradient(AT_V, psi, (v, 0.0), 1.0)
        taken = (kappa * (1.0 - v) - b * ages.evolution(AT_V, psi, v, 1.0)) / held
        by_y = -v * (kappa + b * by_v + damping * taken) / held
        return (by_y, -b * by_psi / held), (v * by_v, by_psi)

    start = _first(rig, a), log(rig.ratio)
    solve: Any = odeint
    with catch_warnings(), suppress(ArithmeticError, ODEintWarning):
        simplefilter("error", ODEintWarning)  # it gives up where the slip begins to run away
        places = np.append(0.0, times)
        # found by differences, it fails on one stiff rig in ten
        found = solve(rate, start, places, Dfun=jacobian, rtol=TOLERANCE, atol=TOLERANCE)
        return np.asarray(found[1:])
    return None
