"""Rate-and-state friction with two states: ageing law and slip law."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple, Self

from stiction.friction.law import Internal, Vector
from stiction.friction.laws.rate_and_state.common import (
    Ageing,
    Slipping,
    comparable,
    evolution,
    evolution_gradient,
    faults,
    friction_force,
    friction_gradient,
    grain_of,
    slip_speed,
    steady,
    steady_log_theta,
)
from stiction.friction.registry import register
from stiction.text.units import Coefficient, PositiveLength, PositiveNumber, PositiveSpeed
from stiction.text.validation import validate


@validate
class TwoStates(NamedTuple):
    """Base of both laws; see `stiction.friction.laws.rate_and_state` for the symbols."""

    a: PositiveNumber
    b_1: Coefficient
    D_1: PositiveLength
    b_2: Coefficient
    D_2: PositiveLength
    mu_star: Coefficient
    V_star: PositiveSpeed

    @classmethod
    def like(cls, static: float, kinetic: float, speed: float) -> Self:
        """Return a comparable law: as with one state, with b/2 over D and b/2 over 10 D."""
        a, b, D, mu_star, V_star = comparable(static, kinetic, speed)
        return cls(a, b / 2, D, b / 2, 10 * D, mu_star, V_star)

    def faults(law) -> Iterator[tuple[str, str]]:
        """Yield contradictions between the parameters."""
        return faults(law.a, law.b_1 + law.b_2, law.mu_star)

    @staticmethod
    def states() -> tuple[Internal, ...]:
        """Return the logarithms of both contact times."""
        return (
            Internal("log_theta_1", "1", "logarithm of the first state, ln(V* theta_1/D_1)"),
            Internal("log_theta_2", "1", "logarithm of the second state, ln(V* theta_2/D_2)"),
        )

    def coefficient(law, v: float) -> float:
        """Return the coefficient of steady sliding at `v`, but at least 1e-12 m/s."""
        return steady(law.a, law.b_1 + law.b_2, law.mu_star, law.V_star, v)

    def settled(law, speed: float) -> tuple[float, ...]:
        """Return the states of steady sliding at `speed` (m/s), or at V_star if it is zero."""
        both = steady_log_theta(law.V_star, speed)
        return (both, both)

    def force(law, slip: Vector, load: float, state: tuple[float, ...]) -> Vector:
        """Return the friction force (N)."""
        psi = law.mu_star + law.b_1 * state[0] + law.b_2 * state[1]
        return friction_force(law.a, law.V_star, psi, slip, load)

    def grain(law, state: tuple[float, ...]) -> float:
        """Return the slip speed below which friction is proportional to slip (m/s)."""
        psi = law.mu_star + law.b_1 * state[0] + law.b_2 * state[1]
        return grain_of(law.a, law.V_star, psi)

    def change(law, slip: Vector, load: float, state: tuple[float, ...]) -> tuple[float, ...]:
        """Return d(log_theta_i)/dt, per second."""
        V = slip_speed(slip)
        return evolution(law, state[0], V, law.D_1), evolution(law, state[1], V, law.D_2)

    def gradient(
        law, slip: Vector, load: float, state: tuple[float, ...]
    ) -> tuple[tuple[float, ...], ...]:
        """Return the derivatives of force and change by slip x, y and the states."""
        psi = law.mu_star + law.b_1 * state[0] + law.b_2 * state[1]
        xx, xy, yy, x, y = friction_gradient(law.a, law.V_star, psi, slip, load)
        one = evolution_gradient(law, state[0], slip, law.D_1)
        two = evolution_gradient(law, state[1], slip, law.D_2)
        return (
            (xx, xy, law.b_1 * x, law.b_2 * x),
            (xy, yy, law.b_1 * y, law.b_2 * y),
            (one[0], one[1], one[2], 0.0),
            (two[0], two[1], 0.0, two[2]),
        )


@register("rate-and-state-ageing-2")
class RateStateAgeing2(Ageing, TwoStates):
    """Rate-and-state friction with two states, ageing law (Dieterich 1979).

        mu = a asinh[(V/2V*) exp((mu* + b_1 ln(V* theta_1/D_1) + b_2 ln(V* theta_2/D_2))/a)],
        theta_i' = 1 - V theta_i/D_i

    See `stiction.friction.laws.rate_and_state` for the symbols. The internal states in results and
    in ``Initial(states=...)`` are ``log_theta_i`` = ln(V* theta_i/D_i). Two are what experiments
    with steps of the slip speed often take (Ruina 1983; Gu et al. 1984,
    doi:10.1016/0022-5096(84)90007-3).

    Parameters
    ----------
    a, b_1, b_2 : float
        Direct and evolution effects; steady sliding weakens if b_1 + b_2 > a.
    D_1, D_2 : float or str
        Slip distances over which the states evolve, m.
    mu_star : float
        Coefficient of steady sliding at V_star.
    V_star : float or str
        Reference slip speed, m/s; any.

    Examples
    --------
    >>> import stiction as st
    >>> law = st.laws.RateStateAgeing2(
    ...     mu_star=0.6, a=0.01, b_1=0.01, D_1="5 um", b_2=0.005, D_2="50 um", V_star="1 um/s")
    >>> round(law.coefficient(1e-5), 4)
    0.5885
    """

    __slots__ = ()


@register("rate-and-state-slip-2")
class RateStateSlip2(Slipping, TwoStates):
    """Rate-and-state friction with two states, slip law (Ruina 1983).

        mu = a asinh[(V/2V*) exp((mu* + b_1 ln(V* theta_1/D_1) + b_2 ln(V* theta_2/D_2))/a)],
        theta_i' = -(V theta_i/D_i) ln(V theta_i/D_i)

    See `stiction.friction.laws.rate_and_state` for the symbols. The internal states in results and
    in ``Initial(states=...)`` are ``log_theta_i`` = ln(V* theta_i/D_i). Two are what experiments
    with steps of the slip speed often take (Ruina 1983; Gu et al. 1984,
    doi:10.1016/0022-5096(84)90007-3).

    Parameters
    ----------
    a, b_1, b_2 : float
        Direct and evolution effects; steady sliding weakens if b_1 + b_2 > a.
    D_1, D_2 : float or str
        Slip distances over which the states evolve, m.
    mu_star : float
        Coefficient of steady sliding at V_star.
    V_star : float or str
        Reference slip speed, m/s; any.

    Examples
    --------
    >>> import stiction as st
    >>> law = st.laws.RateStateSlip2(
    ...     mu_star=0.6, a=0.01, b_1=0.01, D_1="5 um", b_2=0.005, D_2="50 um", V_star="1 um/s")
    >>> round(law.coefficient(1e-5), 4)
    0.5885
    """

    __slots__ = ()
