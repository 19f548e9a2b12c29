"""The slip coordinate q, in which friction is nearly linear: s = eps sinh(|q|) q/|q| (M64).

Rate-and-state friction is proportional to the slip velocity below a speed eps, which may
be 1e-30 m/s, and to its logarithm above. With eps infinite, q is the slip velocity itself.
"""

from __future__ import annotations

from math import asinh, cosh, exp, hypot, inf, log, sinh, sqrt
from typing import NamedTuple

from stiction.arrays import TINY
from stiction.solver.compilation.jit import inlined

SMALL = 0.2  # below, the series are exact to the last digit; above, differences of exponentials
# ratios of successive factors of q^2 in sinh(q)/q, and in 3 (cosh(q) - sinh(q)/q)/q^2
ROUND = (1 / 6, 1 / 20, 1 / 42, 1 / 72, 1 / 110)
OUTER = (1 / 10, 1 / 28, 1 / 54, 1 / 88, 1 / 130)
LARGEST_ARGUMENT = 700.0  # sinh of more overflows
ROUNDS = 30
GENTLE = 0.1  # rise that is not damped
ROUGHLY = 1e-3  # change of q: the damped one need not be known better


@inlined
def series(x: float, ratios: tuple[float, float, float, float, float]) -> float:
    """Return 1 + r_1 x (1 + r_2 x (1 + ...))."""
    a, b, c, d, e = ratios
    return 1.0 + a * x * (1.0 + b * x * (1.0 + c * x * (1.0 + d * x * (1.0 + e * x))))


class SlipAndSlope(NamedTuple):
    """Slip velocity (m/s) and its derivative by q (M65), which is symmetric (m/s)."""

    x: float
    y: float
    xx: float
    xy: float
    yy: float


@inlined
def slip_and_slope(eps: float, q_x: float, q_y: float) -> SlipAndSlope:
    """Return the slip velocity and its derivative, from one exponential."""
    if eps == inf:
        return SlipAndSlope(q_x, q_y, 1.0, 0.0, 1.0)
    square = q_x * q_x + q_y * q_y
    if square < SMALL * SMALL:
        f, outer = eps * series(square, ROUND), eps / 3.0 * series(square, OUTER)
    else:
        q = sqrt(square)
        up = 0.5 * exp(min(q, LARGEST_ARGUMENT))
        down = 0.25 / up
        f = eps * (up - down) / q
        outer = (eps * (up + down) - f) / square
    return SlipAndSlope(
        f * q_x, f * q_y, f + outer * q_x * q_x, outer * q_x * q_y, f + outer * q_y * q_y
    )


@inlined
def slip_at(eps: float, q_x: float, q_y: float) -> tuple[float, float]:
    """Return the slip velocity (m/s)."""
    s = slip_and_slope(eps, q_x, q_y)
    return s.x, s.y


@inlined
def coordinate(eps: float, s_x: float, s_y: float) -> tuple[float, float]:
    """Return q for a slip velocity (m/s)."""
    if eps == inf:
        return s_x, s_y
    s = abs(s_x) if s_y == 0.0 else hypot(s_x, s_y)  # the square may underflow
    f = asinh(s / eps) / s if s > 0.0 else 0.0
    return f * s_x, f * s_y


@inlined
def damped_rise(q: float, rise: float, share: float) -> float:
    """Return |q| after a damped update by `rise` > 0 (M69), given the share of inertia.

    In Newton's equations inertia is exponential in q, and friction about linear in it. The plain
    update would be right if both were linear; this function solves

        share (sinh q' - sinh q)/cosh q + (1 - share) (q' - q) = rise

    instead. It is convex, so Newton's method converges from above.
    """
    if rise < GENTLE:
        return q + rise
    most = min(q + rise / max(1.0 - share, TINY), LARGEST_ARGUMENT)
    if share > 0.0:
        # sinh q' = sinh q + cosh q rise/share, for large values too
        x = rise / share
        there = q + log(1.0 + 2.0 * x) if q > 1.0 else asinh(sinh(q) + cosh(q) * x)
        most = min(most, there)
    y = most
    for _ in range(ROUNDS):
        up, down = exp(min(y - q, LARGEST_ARGUMENT)), exp(-y - q)
        unit = 1.0 + exp(-2.0 * q)
        # sinh y/cosh q and cosh y/cosh q without overflow
        sinh_y, cosh_y = (up - down) / unit, (up + down) / unit
        sinh_q = (1.0 - exp(-2.0 * q)) / unit
        value = share * (sinh_y - sinh_q) + (1.0 - share) * (y - q) - rise
        change = value / (share * cosh_y + 1.0 - share)
        y -= change
        if abs(change) < ROUGHLY:
            break
    return max(y, q)
