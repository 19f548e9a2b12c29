"""Weakening as a power of slip speed."""

from __future__ import annotations

from collections.abc import Iterator
from math import exp, log
from typing import NamedTuple

from stiction.friction.law import refuse_strengthening, static_fault
from stiction.friction.registry import register
from stiction.text.units import Coefficient, PositiveNumber, PositiveSpeed
from stiction.text.validation import validate


@register("power-law-weakening")
@validate
class PowerLawWeakening(NamedTuple):
    """F = mu_0 (1 + v/v_0)^(-n) W.

    A fit of friction of rosin is 0.2 (v + 0.011)^(-0.4), v in m/s: mu_0 = 1.2147,
    v_0 = 11 mm/s, n = 0.4 (Woodhouse & Galluzzo, Tribology Letters 73 (2025), 128,
    doi:10.1007/s11249-025-02062-4, on models of bowed strings). With n = 1 it is
    `HyperbolicWeakening`.

    Parameters
    ----------
    mu_0 : float
        Friction coefficient at vanishing slip speed.
    v_0 : float or str
        Slip speed from which on the power shows, m/s.
    n : float
        Exponent, greater than zero.
    mu_static : float, optional
        Separate coefficient of static friction, not below mu_0; by default none.

    Examples
    --------
    >>> import stiction as st
    >>> st.laws.PowerLawWeakening(mu_0=0.4, v_0="10 mm/s", n=1.0).coefficient(0.01)
    0.2
    """

    mu_0: Coefficient
    v_0: PositiveSpeed
    n: PositiveNumber
    mu_static: Coefficient = 0.0

    @classmethod
    def like(cls, static: float, kinetic: float, speed: float) -> PowerLawWeakening:
        """Return the law with n = 1/2, the coefficient `static`, and a comparable slope at rest.

        The slope is -(static - kinetic)/speed, because this law has no plateau to fall to.
        """
        refuse_strengthening("PowerLawWeakening", static, kinetic)
        return cls(static, 0.5 * speed * static / (static - kinetic), 0.5)

    def faults(law) -> Iterator[tuple[str, str]]:
        """Yield contradictions between the parameters."""
        return static_fault(law)

    def coefficient(law, v: float) -> float:
        """Return the friction coefficient at slip speed `v` (m/s)."""
        return law.mu_0 * exp(-law.n * log(1.0 + v / law.v_0))

    def slope(law, v: float) -> float:
        """Return d(coefficient)/dv at slip speed `v` (m/s), in s/m."""
        return -law.n / (law.v_0 + v) * law.mu_0 * exp(-law.n * log(1.0 + v / law.v_0))
