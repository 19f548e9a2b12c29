"""A slider of rate-and-state friction on a spring, without inertia, after a step of the drive.

With the slip speed v = V e^y after a step to V, the state theta = theta_V e^psi, where theta_V is
that of steady sliding at V, and lengths in D_c, times in D_c/V:

    mu - mu_V = a y + b psi,   (a + g e^y) y' = (k D_c/W) (1 - e^y) - b psi',

where g = c V/W stands for a damper beside the spring (J. R. Rice & A. L. Ruina, J. Appl. Mech. 50,
343 (1983); L. A. Reinen & J. D. Weeks, J. Geophys. Res. 98, 15937 (1993)). On a rig of any
stiffness it begins with steady sliding at V_0: psi = -y = ln(V/V_0).
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from math import exp, expm1, isfinite, log
from typing import Literal, NamedTuple

import numpy as np

from stiction.arrays import Floats

Law = Literal["slip", "ageing", "perrin"]
Evolution = Callable[[float, float], tuple[float, float, float]]

TOLERANCE = 1e-6  # of y and psi in a step
MOST = 1000  # steps: of a slip that runs away, or of an oscillation that is hardly damped
FASTEST = 30.0  # logarithm of the slip speed over V at which a slip has run away

# Rosenbrock's method RODAS of order 4(3), L-stable (E. Hairer & G. Wanner, Solving Ordinary
# Differential Equations II, Springer 1996, section VI.4)
_GAMMA = 0.25
_A21 = 1.544
_A31, _A32 = 0.9466785280815826, 0.2557011698983284
_A41, _A42, _A43 = 3.314825187068521, 2.896124015972201, 0.9986419139977817
_A51, _A52, _A53, _A54 = (
    *(1.221224509226641, 6.019134481288629),
    *(12.53708332932087, -0.6878860361058950),
)
_C21 = -5.6688
_C31, _C32 = -2.430093356833875, -0.2063599157091915
_C41, _C42, _C43 = -0.1073529058151375, -9.594562251023355, -20.47028614809616
_C51, _C52, _C53, _C54 = (
    *(7.496443313967647, -10.24680431464352),
    *(-33.99990352819905, 11.70890893206160),
)
_C61, _C62, _C63, _C64, _C65 = (
    *(8.083246795921522, -7.981132988064893, -31.52159432874371),
    *(16.31930543123136, -6.058818238834054),
)


def _ageing(y: float, psi: float) -> tuple[float, float, float]:
    """Return psi' and its derivatives by y and psi: theta' = 1 - v theta/D_c."""
    v, rest = exp(y), exp(-psi)
    return rest - v, -v, -rest


def _slip(y: float, psi: float) -> tuple[float, float, float]:
    """Return psi' and its derivatives by y and psi: theta' = -(v theta/D_c) ln(v theta/D_c)."""
    v, x = exp(y), y + psi
    return -v * x, -v * (x + 1.0), -v


def _perrin(y: float, psi: float) -> tuple[float, float, float]:
    """Return psi' and its derivatives by y and psi: theta' = 1 - (v theta/2D_c)^2."""
    square, rest = exp(2.0 * y + psi), exp(-psi)
    return 0.5 * (rest - square), -square, -0.5 * (rest + square)


EVOLUTIONS: dict[Law, Evolution] = {"ageing": _ageing, "slip": _slip, "perrin": _perrin}


class SpringSlider(NamedTuple):
    """What a step of the drive meets: parameters over which nothing is fitted.

    Attributes
    ----------
    ratio : float
        Of the speeds after and before the step.
    stiffness, damping : float
        k/W, 1/m, and c V/W, 1.
    """

    ratio: float
    stiffness: float
    damping: float


class SlipCourse(NamedTuple):
    """y, psi and their derivatives at the ends of the steps, (n, 2) each, over time, (n,)."""

    time: Floats
    state: Floats
    rate: Floats

    def at(self, time: Floats) -> Floats:
        """Return y and psi at times within the course, (m, 2), by cubic interpolation."""
        which = np.clip(np.searchsorted(self.time, time) - 1, 0, len(self.time) - 2)
        h = (self.time[which + 1] - self.time[which])[:, None]
        x = (time - self.time[which])[:, None] / h
        one, two = self.state[which], self.state[which + 1]
        slope, end = h * self.rate[which], h * self.rate[which + 1]
        rise = two - one
        found: Floats = one + x * (
            slope + x * (3.0 * rise - 2.0 * slope - end + x * (slope + end - 2.0 * rise))
        )
        return found


def friction_after_a_step(
    rig: SpringSlider, law: Law, a: float, b: float, D_c: float, slip: Floats
) -> Floats | None:
    """Return spring force over load, less that of steady sliding afterwards; None if it slips away.

    Parameters
    ----------
    slip : ndarray
        (n,), ascending travel of the drive since the step, m.
    """
    kappa = rig.stiffness * D_c
    found = _course(rig, law, a, b, kappa, max(float(slip[-1]) / D_c, 1e-9))
    if found is None:
        return None
    y, psi = found.at(slip / D_c).T
    return np.asarray(a * y + b * psi + rig.damping * np.expm1(y))


def _first(rig: SpringSlider, a: float) -> float:
    """Return y just after the step: a damper takes up part of the jump, as the spring cannot."""
    low = -log(rig.ratio)
    if not rig.damping:
        return low
    ends, start = sorted((low, 0.0)), low
    for _ in range(60):
        middle = 0.5 * (ends[0] + ends[1])
        above = a * (middle - start) + rig.damping * expm1(middle) > 0.0
        ends[1 if above else 0] = middle
    return 0.5 * (ends[0] + ends[1])


def _course(
    rig: SpringSlider, law: Law, a: float, b: float, kappa: float, end: float
) -> SlipCourse | None:
    """Integrate y and psi; return None where the slip runs away."""
    system = _System(rig.damping, EVOLUTIONS[law], a, b, kappa)
    z, t = complex(_first(rig, a), log(rig.ratio)), 0.0
    rate = system.rate(z)
    rows = [(t, z, rate)]
    h = min(end, 1e-3 / (1.0 + abs(rate)))
    while t < end:
        if len(rows) > MOST or h < 1e-14 * end or z.real > FASTEST:
            return None
        step, off = min(h, end - t), 1e4
        with suppress(OverflowError, ZeroDivisionError):
            after, off = system.step(z, step)
            if off <= 1.0:
                t, z = t + step, after
                rows.append((t, z, system.rate(z)))
        h = step * (min(5.0, max(0.2, 0.9 * (off + 1e-9) ** -0.25)) if isfinite(off) else 0.2)
    times, states, rates = zip(*rows, strict=True)
    return SlipCourse(
        np.array(times), *(np.array(x).view(float).reshape(-1, 2) for x in (states, rates))
    )


class _System(NamedTuple):
    """The equations of y + i psi, which are two real numbers: complex sums are quick."""

    damping: float
    evolution: Evolution
    a: float
    b: float
    kappa: float

    def rate(self, z: complex) -> complex:
        """Return y' + i psi'."""
        v, g = exp(z.real), self.evolution(z.real, z.imag)[0]
        return complex((self.kappa * (1.0 - v) - self.b * g) / (self.a + self.damping * v), g)

    def step(self, z: complex, h: float) -> tuple[complex, float]:
        """Return y + i psi after a step, and its error over the tolerance."""
        solve, rate, g = self._solver(z, h), self.rate, 1.0 / h
        p = solve(rate(z))
        q = solve(rate(z + _A21 * p) + g * (_C21 * p))
        r = solve(rate(z + _A31 * p + _A32 * q) + g * (_C31 * p + _C32 * q))
        at = z + _A41 * p + _A42 * q + _A43 * r
        s = solve(rate(at) + g * (_C41 * p + _C42 * q + _C43 * r))
        at = z + _A51 * p + _A52 * q + _A53 * r + _A54 * s
        u = solve(rate(at) + g * (_C51 * p + _C52 * q + _C53 * r + _C54 * s))
        at += u
        w = solve(rate(at) + g * (_C61 * p + _C62 * q + _C63 * r + _C64 * s + _C65 * u))
        return at + w, max(abs(w.real), abs(w.imag)) / TOLERANCE

    def _solver(self, z: complex, h: float) -> Callable[[complex], complex]:
        """Return the solver of the linear equations of a stage of a step."""
        y, psi = z.real, z.imag
        v, (g, g_y, g_psi) = exp(y), self.evolution(y, psi)
        share = self.a + self.damping * v
        f = (self.kappa * (1.0 - v) - self.b * g) / share
        f_y = (-self.kappa * v - self.b * g_y - f * self.damping * v) / share
        f_psi = -self.b * g_psi / share
        left, right = 1.0 / (_GAMMA * h) - f_y, 1.0 / (_GAMMA * h) - g_psi
        of = 1.0 / (left * right - f_psi * g_y)

        def solve(value: complex) -> complex:
            p, q = value.real, value.imag
            return complex(of * (right * p + f_psi * q), of * (left * q + g_y * p))

        return solve
