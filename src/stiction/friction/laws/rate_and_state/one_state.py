"""Rate-and-state friction with one state: ageing law, slip law, and the law of Perrin et al."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple, Self

from stiction.friction.law import Internal, Vector
from stiction.friction.laws.rate_and_state.common import (
    Ageing,
    Slipping,
    Squaring,
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
class OneState(NamedTuple):
    """Base of these laws; see `stiction.friction.laws.rate_and_state` for the symbols."""

    a: PositiveNumber
    b: Coefficient
    D_c: PositiveLength
    mu_star: Coefficient
    V_star: PositiveSpeed

    @classmethod
    def like(cls, static: float, kinetic: float, speed: float) -> Self:
        """Return a comparable law; see `stiction.friction.laws.rate_and_state`."""
        return cls(*comparable(static, kinetic, speed))

    def faults(law) -> Iterator[tuple[str, str]]:
        """Yield contradictions between the parameters."""
        return faults(law.a, law.b, law.mu_star)

    @staticmethod
    def states() -> tuple[Internal, ...]:
        """Return the logarithm of the contact time."""
        return (Internal("log_theta", "1", "logarithm of the state, ln(V* theta/D_c)"),)

    def coefficient(law, v: float) -> float:
        """Return the coefficient of steady sliding at `v`, but at least 1e-12 m/s."""
        return steady(law.a, law.b, law.mu_star, law.V_star, v)

    def settled(law, speed: float) -> tuple[float, ...]:
        """Return the state of steady sliding at `speed` (m/s), or at V_star if it is zero."""
        return (steady_log_theta(law.V_star, speed),)

    def force(law, slip: Vector, load: float, state: tuple[float, ...]) -> Vector:
        """Return the friction force (N)."""
        return friction_force(law.a, law.V_star, law.mu_star + law.b * state[0], slip, load)

    def grain(law, state: tuple[float, ...]) -> float:
        """Return the slip speed below which friction is proportional to slip (m/s)."""
        return grain_of(law.a, law.V_star, law.mu_star + law.b * state[0])

    def change(law, slip: Vector, load: float, state: tuple[float, ...]) -> tuple[float, ...]:
        """Return d(log_theta)/dt, per second."""
        return (evolution(law, state[0], slip_speed(slip), law.D_c),)

    def gradient(
        law, slip: Vector, load: float, state: tuple[float, ...]
    ) -> tuple[tuple[float, ...], ...]:
        """Return the derivatives of force and change by slip x, y and the state."""
        psi = law.mu_star + law.b * state[0]
        xx, xy, yy, x, y = friction_gradient(law.a, law.V_star, psi, slip, load)
        own = evolution_gradient(law, state[0], slip, law.D_c)
        return ((xx, xy, law.b * x), (xy, yy, law.b * y), own)


@register("rate-and-state-ageing")
class RateStateAgeing(Ageing, OneState):
    """Rate-and-state friction, ageing law (Dieterich 1979).

        mu = a asinh[(V/2V*) exp((mu* + b ln(V* theta/D_c))/a)],
        theta' = 1 - V theta/D_c

    See `stiction.friction.laws.rate_and_state` for the symbols and the regularised form. The
    internal state in results and in ``Initial(states=...)`` is ``log_theta`` = ln(V* theta/D_c).
    The contacts age: during a hold the state grows with time (healing).

    Parameters
    ----------
    a, b : float
        Direct and evolution effect; in rock 0.005 to 0.02. Steady sliding weakens if b > a.
    D_c : float or str
        Slip distance over which the state evolves, m; 1 to 100 um in the laboratory.
    mu_star : float
        Coefficient of steady sliding at V_star.
    V_star : float or str
        Reference slip speed, m/s; any.

    Examples
    --------
    >>> import stiction as st
    >>> law = st.laws.RateStateAgeing(mu_star=0.6, a=0.010, b=0.015, D_c="10 um", V_star="1 um/s")
    >>> law.coefficient(1e-6), round(law.coefficient(1e-5), 4)
    (0.6, 0.5885)
    """

    __slots__ = ()


@register("rate-and-state-slip")
class RateStateSlip(Slipping, OneState):
    """Rate-and-state friction, slip law (Ruina 1983).

        mu = a asinh[(V/2V*) exp((mu* + b ln(V* theta/D_c))/a)],
        theta' = -(V theta/D_c) ln(V theta/D_c)

    See `stiction.friction.laws.rate_and_state` for the symbols and the regularised form. The
    internal state in results and in ``Initial(states=...)`` is ``log_theta`` = ln(V* theta/D_c).
    The state evolves only with slip: without slip nothing heals.

    Parameters
    ----------
    a, b : float
        Direct and evolution effect; in rock 0.005 to 0.02. Steady sliding weakens if b > a.
    D_c : float or str
        Slip distance over which the state evolves, m; 1 to 100 um in the laboratory.
    mu_star : float
        Coefficient of steady sliding at V_star.
    V_star : float or str
        Reference slip speed, m/s; any.

    Examples
    --------
    >>> import stiction as st
    >>> law = st.laws.RateStateSlip(mu_star=0.6, a=0.010, b=0.015, D_c="10 um", V_star="1 um/s")
    >>> round(law.coefficient(1e-5), 4)
    0.5885
    """

    __slots__ = ()


@register("rate-and-state-perrin")
class RateStatePerrin(Squaring, OneState):
    """Rate-and-state friction, law of Perrin, Rice & Zheng (1995).

        mu = a asinh[(V/2V*) exp((mu* + b ln(V* theta/2D_c))/a)],
        theta' = 1 - (V theta/2D_c)^2

    See `stiction.friction.laws.rate_and_state` for the symbols and the regularised form.
    The internal state in results and in ``Initial(states=...)`` is ``log_theta`` =
    ln(V* theta/2D_c): in steady sliding theta is 2 D_c/V. Contacts age at rest, as by the ageing
    law; after a small step of the slip speed, friction changes exponentially with slip, as by the
    slip law. (J. Mech. Phys. Solids 43, 1461.)

    Parameters
    ----------
    a, b : float
        Direct and evolution effect; in rock 0.005 to 0.02. Steady sliding weakens if b > a.
    D_c : float or str
        Slip distance over which the state evolves, m; 1 to 100 um in the laboratory.
    mu_star : float
        Coefficient of steady sliding at V_star.
    V_star : float or str
        Reference slip speed, m/s; any.

    Examples
    --------
    >>> import stiction as st
    >>> law = st.laws.RateStatePerrin(mu_star=0.6, a=0.010, b=0.015, D_c="10 um", V_star="1 um/s")
    >>> round(law.coefficient(1e-5), 4)
    0.5885
    """

    __slots__ = ()
