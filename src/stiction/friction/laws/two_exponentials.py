"""Weakening over two slip speeds."""

from __future__ import annotations

from collections.abc import Iterator
from math import exp
from typing import NamedTuple

from stiction.friction.law import static_fault
from stiction.friction.registry import register
from stiction.text.units import Coefficient, PositiveSpeed
from stiction.text.validation import validate


@register("two-exponentials")
@validate
class TwoExponentials(NamedTuple):
    """F = [mu_inf + mu_1 exp(-v/v_1) + mu_2 exp(-v/v_2)] W.

    Measured so for rosin in steady sliding: 0.35 + 0.4 exp(-v/10 mm/s) + 0.45 exp(-v/100 mm/s)
    (Smith & Woodhouse, J. Mech. Phys. Solids 48 (2000), 1633).

    Parameters
    ----------
    mu_inf : float
        Friction coefficient at large slip speed.
    mu_1, mu_2 : float
        What is lost over each speed.
    v_1, v_2 : float or str
        Slip speeds over which it is lost, m/s.
    mu_static : float, optional
        Separate coefficient of static friction, not below the sum of all three; by default none.

    Examples
    --------
    >>> import stiction as st
    >>> law = st.laws.TwoExponentials(
    ...     mu_inf=0.35, mu_1=0.4, v_1="10 mm/s", mu_2=0.45, v_2="0.1 m/s")
    >>> round(law.coefficient(0.0), 3)
    1.2
    """

    mu_inf: Coefficient
    mu_1: Coefficient
    v_1: PositiveSpeed
    mu_2: Coefficient
    v_2: PositiveSpeed
    mu_static: Coefficient = 0.0

    @classmethod
    def like(cls, static: float, kinetic: float, speed: float) -> TwoExponentials:
        """Return the law with half of the loss at half the given speed, and half at twice."""
        lost = 0.5 * (static - kinetic)
        return cls(kinetic, lost, 0.5 * speed, lost, 2.0 * speed)

    def faults(law) -> Iterator[tuple[str, str]]:
        """Yield contradictions between the parameters."""
        return static_fault(law)

    def coefficient(law, v: float) -> float:
        """Return the friction coefficient at slip speed `v` (m/s)."""
        return law.mu_inf + law.mu_1 * exp(-v / law.v_1) + law.mu_2 * exp(-v / law.v_2)

    def slope(law, v: float) -> float:
        """Return d(coefficient)/dv at slip speed `v` (m/s), in s/m."""
        return -law.mu_1 / law.v_1 * exp(-v / law.v_1) - law.mu_2 / law.v_2 * exp(-v / law.v_2)
