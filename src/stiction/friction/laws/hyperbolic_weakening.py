"""Hyperbolic weakening with slip speed, the textbook law of stick-slip on a belt."""

from __future__ import annotations

from collections.abc import Iterator
from math import e
from typing import NamedTuple

from stiction.friction.law import refuse_strengthening, static_fault
from stiction.friction.registry import register
from stiction.text.units import Coefficient, PositiveSpeed
from stiction.text.validation import validate


@register("hyperbolic-weakening")
@validate
class HyperbolicWeakening(NamedTuple):
    """F = [mu_inf + (mu_0 - mu_inf)/(1 + v/v_h)] W.

    Leine, van Campen, de Kraker & van den Steen, Nonlinear Dynamics 16 (1998), 41, write it
    F_s/(1 + delta v), delta = 1/v_h, with delta = 3 s/m. There friction falls towards zero: that is
    meant for slip speeds of the order of v_h. With mu_inf = 0.4, mu_0 = 0.8 and v_h = 0.2 m/s it is
    what models of bowed strings take for rosin (`stiction presets`).

    Parameters
    ----------
    mu_0 : float
        Friction coefficient at vanishing slip speed.
    v_h : float or str
        Slip speed at which the coefficient has fallen by half, m/s.
    mu_static : float, optional
        Separate coefficient of static friction, not below mu_0; by default none.
    mu_inf : float, optional
        Friction coefficient at large slip speed; by default zero.

    Examples
    --------
    >>> import stiction as st
    >>> st.laws.HyperbolicWeakening(mu_0=0.4, v_h="10 mm/s").coefficient(0.01)
    0.2
    """

    mu_0: Coefficient
    v_h: PositiveSpeed
    mu_static: Coefficient = 0.0
    mu_inf: Coefficient = 0.0

    @classmethod
    def like(cls, static: float, kinetic: float, speed: float) -> HyperbolicWeakening:
        """Return the law that falls from `static` to `kinetic`, by 1 - 1/e of that at `speed`."""
        refuse_strengthening("HyperbolicWeakening", static, kinetic)
        return cls(static, speed / (e - 1.0), mu_inf=kinetic)

    def faults(law) -> Iterator[tuple[str, str]]:
        """Yield contradictions between the parameters."""
        return static_fault(law)

    def coefficient(law, v: float) -> float:
        """Return the friction coefficient at slip speed `v` (m/s)."""
        return law.mu_inf + (law.mu_0 - law.mu_inf) / (1.0 + v / law.v_h)

    def slope(law, v: float) -> float:
        """Return d(coefficient)/dv at slip speed `v` (m/s), in s/m."""
        x = 1.0 + v / law.v_h
        return (law.mu_inf - law.mu_0) / (law.v_h * x * x)
