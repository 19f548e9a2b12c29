"""The Stribeck law: a peak at rest, a trough, and viscous friction beyond it."""

from __future__ import annotations

from collections.abc import Iterator
from math import exp
from typing import NamedTuple

from stiction.friction.law import static_fault
from stiction.friction.registry import register
from stiction.text.units import Coefficient, Exponent, PerSpeed, PositiveSpeed
from stiction.text.validation import validate

GONE = 750.0  # exp(-750) is zero in floating point


@register("stribeck")
@validate
class Stribeck(NamedTuple):
    """F = [mu_c + (mu_s - mu_c) exp(-(v/v_s)^d) + c v] W.

    Stribeck (1902) measured the trough between the solid friction of a bearing at rest and
    the viscous friction of its film; Bo & Pavelescu, Wear 82 (1982), 277, give the form with an
    exponent; review: Armstrong-Helouvry, Dupont & Canudas de Wit, Automatica 30 (1994), 1083.
    With d = 1 and c = 0 it is `ExponentialWeakening`.

    Parameters
    ----------
    mu_s : float
        Friction coefficient at vanishing slip speed: dry metals 0.2 to 0.8, greased 0.1 to 0.2.
    mu_c : float
        Coefficient of the solid part at large slip speed, some 0.6 to 0.9 of mu_s.
    v_s : float or str
        Stribeck velocity, m/s; 0.1 mm/s to 0.1 m/s.
    d : float, optional
        Exponent, 1 to 10: 2 is usual (Gaussian), 1 the exponential law. Below 1 the slope at
        vanishing slip speed would be infinite.
    c : float or str, optional
        Viscous friction per normal load, s/m; by default none.
    mu_static : float, optional
        Separate coefficient of static friction, not below mu_s; by default none.

    Examples
    --------
    >>> import stiction as st
    >>> law = st.laws.Stribeck(mu_s=0.3, mu_c=0.2, v_s="10 mm/s", c="0.5 s/m")
    >>> round(law.coefficient(0.0), 3), round(law.coefficient(1.0), 3)
    (0.3, 0.7)
    """

    mu_s: Coefficient
    mu_c: Coefficient
    v_s: PositiveSpeed
    d: Exponent = 2.0
    c: PerSpeed = 0.0
    mu_static: Coefficient = 0.0

    @classmethod
    def like(cls, static: float, kinetic: float, speed: float) -> Stribeck:
        """Return the law with these coefficients and this speed, without viscous friction."""
        return cls(static, kinetic, speed)

    def faults(law) -> Iterator[tuple[str, str]]:
        """Yield contradictions between the parameters."""
        return static_fault(law)

    def coefficient(law, v: float) -> float:
        """Return the friction coefficient at slip speed `v` (m/s)."""
        x = min(v / law.v_s, GONE)
        fallen: float = exp(-(x**law.d))
        return law.mu_c + (law.mu_s - law.mu_c) * fallen + law.c * v

    def slope(law, v: float) -> float:
        """Return d(coefficient)/dv at slip speed `v` (m/s), in s/m."""
        x = min(v / law.v_s, GONE)
        fall: float = law.d / law.v_s * x ** (law.d - 1.0) * exp(-(x**law.d))
        return (law.mu_c - law.mu_s) * fall + law.c
