"""The equations of the cases for peers, compiled with numba, each with its derivatives.

Unknowns are those of `cases`. The parameters of all end with stiffness (N/m), mass (kg) and drive
velocity (m/s); the load is 1 N.
"""

from __future__ import annotations

from math import asinh, exp, log, sqrt

import numba

from benchmarks.precision import equations as fig_3
from benchmarks.state_laws.cases import AGEING, INERTIA, LUGRE, SLIP, SMOOTHED

FIRM = 30.0  # above, asinh(exp(x)) is x + ln 2 to the last digit


@numba.njit(inline="always")
def ageing(x, theta, p):
    """Return the rate of ln V* theta/D_c by the ageing law, and its derivatives by x and itself."""
    D, V_star = p[2], p[4]
    V, aged = V_star * exp(x), V_star * exp(-theta)
    return (aged - V) / D, -V / D, -aged / D


@numba.njit(inline="always")
def slipping(x, theta, p):
    """Do as `ageing` by the slip law."""
    per = p[4] * exp(x) / p[2]
    return -per * (x + theta), -per * (x + theta + 1.0), -per


def quasi_static(evolution):
    """Return right-hand side and Jacobian without inertia: a x' + b theta' = k (v_d - V)."""

    @numba.njit
    def derivative(t, y, p, out):
        a, b, k, v_d = p[0], p[1], p[5], p[7]
        rate, _, _ = evolution(y[0], y[1], p)
        out[0] = (k * (v_d - p[4] * exp(y[0])) - b * rate) / a
        out[1] = rate

    @numba.njit
    def jacobian(t, y, p, out):
        a, b, k = p[0], p[1], p[5]
        _, by_x, by_theta = evolution(y[0], y[1], p)
        out[0, 0] = (-k * p[4] * exp(y[0]) - b * by_x) / a
        out[0, 1] = -b * by_theta / a
        out[1, 0] = by_x
        out[1, 1] = by_theta

    return derivative, jacobian


@numba.njit(inline="always")
def direct_effect(a, z):
    """Return a asinh(exp z) and its derivative by a z."""
    if z > FIRM:
        return a * (z + log(2.0)), 1.0
    e = exp(z)
    return a * asinh(e), e / sqrt(1.0 + e * e)


def inertial(evolution):
    """Return right-hand side and Jacobian with inertia: m V x' = k u - mu(x, theta)."""

    @numba.njit
    def derivative(t, y, p, out):
        V = p[4] * exp(y[1])
        z = y[1] - log(2.0) + (p[3] + p[1] * y[2]) / p[0]
        mu, _ = direct_effect(p[0], z)
        out[0] = p[5] * (p[7] - V)
        out[1] = (y[0] - mu) / (p[6] * V)
        out[2], _, _ = evolution(y[1], y[2], p)

    @numba.njit
    def jacobian(t, y, p, out):
        V = p[4] * exp(y[1])
        z = y[1] - log(2.0) + (p[3] + p[1] * y[2]) / p[0]
        mu, slope = direct_effect(p[0], z)
        _, by_x, by_theta = evolution(y[1], y[2], p)
        per = 1.0 / (p[6] * V)
        out[:] = 0.0
        out[0, 1] = -p[5] * V
        out[1, 0] = per
        out[1, 1] = -per * (p[0] * slope + y[0] - mu)
        out[1, 2] = -per * p[1] * slope
        out[2, 1] = by_x
        out[2, 2] = by_theta

    return derivative, jacobian


@numba.njit
def bristles(t, y, p, out):
    """Write the rates of ``(k u, s/v_s, sigma_0 z)`` into `out`."""
    mu_c, mu_s, v_s, sigma_0, sigma_1, sigma_2 = p[0], p[1], p[2], p[3], p[4], p[5]
    x, f = y[1], y[2]
    s = v_s * x
    g = mu_c + (mu_s - mu_c) * exp(-x * x)
    bend = s - abs(s) * f / g
    out[0] = p[6] * (p[8] - s)
    out[1] = (y[0] - f - sigma_1 * bend - sigma_2 * s) / (p[7] * v_s)
    out[2] = sigma_0 * bend


@numba.njit
def bristles_jacobian(t, y, p, out):
    """Write the derivatives of `bristles` into `out`, (3, 3)."""
    mu_c, mu_s, v_s, sigma_0, sigma_1, sigma_2 = p[0], p[1], p[2], p[3], p[4], p[5]
    x, f = y[1], y[2]
    s = v_s * x
    e = (mu_s - mu_c) * exp(-x * x)
    g = mu_c + e
    sign = 1.0 if x > 0.0 else -1.0 if x < 0.0 else 0.0
    by_x = v_s - sign * v_s * f / g - abs(s) * f * 2.0 * x * e / (g * g)
    by_f = -abs(s) / g
    per = 1.0 / (p[7] * v_s)
    out[:] = 0.0
    out[0, 1] = -p[6] * v_s
    out[1, 0] = per
    out[1, 1] = -per * (sigma_1 * by_x + sigma_2 * v_s)
    out[1, 2] = -per * (1.0 + sigma_1 * by_f)
    out[2, 1] = sigma_0 * by_x
    out[2, 2] = sigma_0 * by_f


MODELS = {
    AGEING: quasi_static(ageing),
    SLIP: quasi_static(slipping),
    AGEING + INERTIA: inertial(ageing),
    SLIP + INERTIA: inertial(slipping),
    LUGRE: (bristles, bristles_jacobian),
    SMOOTHED: (fig_3.derivative, fig_3.jacobian),
}
