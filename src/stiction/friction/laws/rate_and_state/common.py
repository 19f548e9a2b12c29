"""Shared parts of the rate-and-state laws: coefficient, evolution, comparable parameters.

The equations stand in `stiction.friction.laws.rate_and_state`.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import asinh, exp, log, sqrt
from typing import Any, NamedTuple

from stiction.friction.registry import called_by_laws, called_by_type

SLOWEST = 1e-12  # m/s: steady sliding by 30 um a year, because there is no steady state at rest
MOST_FOLDS = 680.0  # e-folds of slip speed between the smallest float and V*
FIRM = 30.0  # above, asinh(exp(x)) is x + ln 2 to the last digit
LOG_2 = log(2.0)
SMALL = 1e-250  # m^2/s^2: above, the sum of two squares has all its digits
UP, DOWN = 2.0**500, 2.0**-500
REST = 1e-300  # m/s: slower is rest, where friction is proportional to slip


@called_by_laws
def slip_speed(slip: tuple[float, float]) -> float:
    """Return |s|, also where the square underflows.

    Unlike `hypot` it is plain arithmetic, which the compiler shares among force, change, gradient.
    """
    x, y = slip
    up, down = (1.0, 1.0) if x * x + y * y > SMALL else (UP, DOWN)
    x, y = up * x, up * y
    return sqrt(x * x + y * y) * down


@called_by_laws
def asinh_of_exp(x: float) -> float:
    """Return asinh(exp(x)), for any x."""
    return x + LOG_2 if x > FIRM else asinh(exp(x))


@called_by_laws
def slope_of_asinh(x: float) -> float:
    """Return the derivative of asinh(exp(x)) by x."""
    if x > FIRM:
        return 1.0
    e = exp(x)
    return e / sqrt(1.0 + e * e)


@called_by_laws
def friction_force(
    a: float, V_star: float, psi: float, slip: tuple[float, float], load: float
) -> tuple[float, float]:
    """Return a W asinh[(V/2V*) exp(psi/a)] along the slip, N."""
    V = max(slip_speed(slip), REST)
    f = a * asinh_of_exp(log(V / V_star) + psi / a - LOG_2) * load / V
    return f * slip[0], f * slip[1]


@called_by_laws
def friction_gradient(
    a: float, V_star: float, psi: float, slip: tuple[float, float], load: float
) -> tuple[float, float, float, float, float]:
    """Return the derivatives of `friction_force`: xx, xy and yy by slip, x and y by psi."""
    V = max(slip_speed(slip), REST)
    x = log(V / V_star) + psi / a - LOG_2
    across = a * asinh_of_exp(x) * load / V
    if V == REST:
        stiff = a * load / grain_of(a, V_star, psi)
        return stiff, 0.0, stiff, 0.0, 0.0
    n_x, n_y = slip[0] / V, slip[1] / V
    by_psi = load * slope_of_asinh(x)
    more = a * by_psi / V - across
    return (
        across + more * n_x * n_x,
        more * n_x * n_y,
        across + more * n_y * n_y,
        by_psi * n_x,
        by_psi * n_y,
    )


@called_by_laws
def grain_of(a: float, V_star: float, psi: float) -> float:
    """Return the slip speed below which friction is proportional to slip, m/s."""
    return 2.0 * V_star * exp(-psi / a)


@called_by_type
def evolution(law: Any, log_theta: float, V: float, D: float) -> float:
    """Return d(log_theta)/dt, per second, by a law's equation for its states."""
    rate: float = law.evolution(log_theta, V, D)
    return rate


@called_by_type
def evolution_gradient(
    law: Any, log_theta: float, slip: tuple[float, float], D: float
) -> tuple[float, float, float]:
    """Return the derivatives of `evolution` by slip x, y and the state."""
    by: tuple[float, float, float] = law.evolution_gradient(log_theta, slip, D)
    return by


class Ageing:
    """The ageing law, theta' = 1 - V theta/D."""

    __slots__ = ()

    def evolution(law: Any, log_theta: float, V: float, D: float) -> float:
        """Return d(log_theta)/dt, per second."""
        return (law.V_star * exp(-log_theta) - V) / D  # type: ignore[no-any-return]

    def evolution_gradient(
        law: Any, log_theta: float, slip: tuple[float, float], D: float
    ) -> tuple[float, float, float]:
        """Return its derivatives by slip x, y and the state."""
        v = max(slip_speed(slip), REST)
        return -slip[0] / v / D, -slip[1] / v / D, -law.V_star * exp(-log_theta) / D


class Slipping:
    """The slip law, theta' = -(V theta/D) ln(V theta/D)."""

    __slots__ = ()

    def evolution(law: Any, log_theta: float, V: float, D: float) -> float:
        """Return d(log_theta)/dt, per second."""
        return -V / D * (log(max(V, REST) / law.V_star) + log_theta)

    def evolution_gradient(
        law: Any, log_theta: float, slip: tuple[float, float], D: float
    ) -> tuple[float, float, float]:
        """Return its derivatives by slip x, y and the state; zero at rest."""
        V = slip_speed(slip)
        v = max(V, REST)
        f = -(log(v / law.V_star) + log_theta + 1.0) / D
        return f * (slip[0] / v), f * (slip[1] / v), -V / D


class Squaring:
    """The law of Perrin, Rice & Zheng, theta' = 1 - (V theta/2D)^2; log_theta = ln(V* theta/2D)."""

    __slots__ = ()

    def evolution(law: Any, log_theta: float, V: float, D: float) -> float:
        """Return d(log_theta)/dt, per second."""
        aged, worn = law.V_star * exp(-log_theta), V * V / law.V_star * exp(log_theta)
        return 0.5 * (aged - worn) / D  # type: ignore[no-any-return]

    def evolution_gradient(
        law: Any, log_theta: float, slip: tuple[float, float], D: float
    ) -> tuple[float, float, float]:
        """Return its derivatives by slip x, y and the state."""
        square, aged = slip[0] * slip[0] + slip[1] * slip[1], exp(log_theta) / (law.V_star * D)
        by_state = -0.5 * (law.V_star * exp(-log_theta) / D + square * aged)
        return -aged * slip[0], -aged * slip[1], by_state


def least_direct_effect(b: float, mu_star: float) -> float:
    """Return the smallest `a` with which floats suffice near rest.

    The slip speed below which friction is proportional to slip, 2 V* exp(-psi/a), must not
    underflow; 30 b allows for contacts that have aged for a hundred days.
    """
    return (mu_star + 30.0 * b) / MOST_FOLDS


def faults(a: float, b: float, mu_star: float) -> Iterator[tuple[str, str]]:
    """Check that the direct effect `a` is large enough for floats near rest."""
    least = least_direct_effect(b, mu_star)
    if a < least:
        yield (
            "a",
            f"must be at least {least:.3g} with this mu_star and b, is {a:g}: below, friction at "
            "rest is as good as set-valued; use Coulomb or ExponentialWeakening",
        )


def steady(a: float, b: float, mu_star: float, V_star: float, v: float) -> float:
    """Return the coefficient of steady sliding, where V theta = D, at `v` or `SLOWEST`."""
    V = max(v, SLOWEST)
    return a * asinh_of_exp(log(V / (2.0 * V_star)) + (mu_star + b * log(V_star / V)) / a)


def steady_log_theta(V_star: float, speed: float) -> float:
    """Return log_theta of steady sliding at `speed` (m/s); at V* if that is zero."""
    return log(V_star / speed) if speed > 0.0 else 0.0


class Comparable(NamedTuple):
    """Parameters comparable with another law's; see `comparable`."""

    a: float
    b: float
    D: float
    mu_star: float
    V_star: float


def comparable(static: float, kinetic: float, speed: float) -> Comparable:
    """Return parameters with the weakening of another law.

    Rate-and-state friction has no static coefficient: the steady one falls by b - a with every
    e-fold of slip speed. The choice here: the steady coefficient is `kinetic` at V* = `speed` and
    `static` at a ten-thousandth of it; b = 2 a, between the usual value for rock (b/a = 1.5) and
    strong weakening; D = 10 um, typical of laboratory surfaces. For friction that does not
    weaken, a is 0.01 and b is smaller.
    """
    weakening = (static - kinetic) / log(1e4)
    a = weakening if weakening > 0.0 else 0.01
    return Comparable(a, max(a + weakening, 0.0), 1e-5, kinetic, speed)
