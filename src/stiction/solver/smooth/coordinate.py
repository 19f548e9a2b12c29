"""The slip coordinate q, in which friction is nearly linear: s = eps sinh(|q|) q/|q| (M64).

Rate-and-state friction is proportional to the slip velocity below a speed eps, which may
be 1e-30 m/s, and to its logarithm above. With eps infinite, q is the slip velocity itself.
"""

from __future__ import annotations

from math import asinh, cosh, exp, hypot, inf, log, sinh, sqrt

from stiction.solver.compilation.jit import inlined

SMALL = 1e-4  # below, sinh(x)/x = 1 + x^2/6 to the last digit
LARGEST = 700.0  # sinh of more overflows
ROUNDS = 30


@inlined
def slip_at(eps: float, q_x: float, q_y: float) -> tuple[float, float]:
    """Return the slip velocity (m/s)."""
    if eps == inf:
        return q_x, q_y
    square = q_x * q_x + q_y * q_y
    if square < SMALL * SMALL:
        f = eps * (1.0 + square / 6.0)
    else:
        q = sqrt(square)
        f = eps * sinh(min(q, LARGEST)) / q
    return f * q_x, f * q_y


@inlined
def coordinate(eps: float, s_x: float, s_y: float) -> tuple[float, float]:
    """Return q at a slip velocity (m/s)."""
    if eps == inf:
        return s_x, s_y
    s = hypot(s_x, s_y)  # the square may underflow
    f = asinh(s / eps) / s if s > 0.0 else 0.0
    return f * s_x, f * s_y


@inlined
def slip_slope(eps: float, q_x: float, q_y: float) -> tuple[float, float, float]:
    """Return ds/dq (M65): xx, xy and yy (m/s)."""
    if eps == inf:
        return 1.0, 0.0, 1.0
    square = q_x * q_x + q_y * q_y
    if square < SMALL * SMALL:
        f, outer = eps * (1.0 + square / 6.0), eps / 3.0
    else:
        q = sqrt(square)
        up = 0.5 * exp(min(q, LARGEST))
        down = 0.25 / up
        f = eps * (up - down) / q
        outer = (eps * (up + down) - f) / square
    return f + outer * q_x * q_x, outer * q_x * q_y, f + outer * q_y * q_y


@inlined
def damped_rise(q: float, rise: float, share: float) -> float:
    """Return |q| after a damped update by `rise` > 0 (M69); `share` is that of inertia.

    In Newton's equations inertia is exponential in q, and friction about linear in it. The plain
    update would be right if both were linear; this function solves

        share (sinh q' - sinh q)/cosh q + (1 - share) (q' - q) = rise

    instead. It is convex, so Newton's method converges from above.
    """
    if rise < 0.1:
        return q + rise
    most = min(q + rise / max(1.0 - share, 1e-300), LARGEST)
    if share > 0.0:
        # sinh q' = sinh q + cosh q rise/share, for large values too
        x = rise / share
        there = q + log(1.0 + 2.0 * x) if q > 1.0 else asinh(sinh(q) + cosh(q) * x)
        most = min(most, there)
    y = most
    for _ in range(ROUNDS):
        up, down = exp(min(y - q, LARGEST)), exp(-y - q)
        unit = 1.0 + exp(-2.0 * q)
        # sinh y/cosh q and cosh y/cosh q without overflow
        sinh_y, cosh_y = (up - down) / unit, (up + down) / unit
        sinh_q = (1.0 - exp(-2.0 * q)) / unit
        value = share * (sinh_y - sinh_q) + (1.0 - share) * (y - q) - rise
        change = value / (share * cosh_y + 1.0 - share)
        y -= change
        if abs(change) < 1e-3:
            break
    return max(y, q)
