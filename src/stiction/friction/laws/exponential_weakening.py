"""The paper's friction law: exponential weakening with slip speed."""

from __future__ import annotations

from collections.abc import Iterator
from math import exp
from typing import NamedTuple

from stiction.friction.law import static_fault
from stiction.friction.registry import register
from stiction.text.units import Coefficient, PositiveSpeed
from stiction.text.validation import validate


@register("exponential-weakening")
@validate
class ExponentialWeakening(NamedTuple):
    """F = [mu_inf + (mu_0 - mu_inf) exp(-v/v_f)] W (Nakano & Popov 2020, "Methods").

    ``mu_inf > mu_0`` describes strengthening.

    Parameters
    ----------
    mu_0 : float
        Friction coefficient at vanishing slip speed.
    mu_inf : float
        Friction coefficient at large slip speed.
    v_f : float or str
        Slip speed over which the coefficient changes, m/s.
    mu_static : float, optional
        Separate coefficient of static friction, not below mu_0; by default none.

    Examples
    --------
    >>> import stiction as st
    >>> law = st.ExponentialWeakening(mu_0=0.20, mu_inf=0.15, v_f="10 mm/s")
    >>> law.coefficient(0.0), round(law.coefficient(0.01), 4)
    (0.2, 0.1684)
    """

    mu_0: Coefficient
    mu_inf: Coefficient
    v_f: PositiveSpeed
    mu_static: Coefficient = 0.0

    @classmethod
    def like(cls, static: float, kinetic: float, speed: float) -> ExponentialWeakening:
        """Return the law with these coefficients and this speed."""
        return cls(static, kinetic, speed)

    def faults(law) -> Iterator[tuple[str, str]]:
        """Yield contradictions between the parameters."""
        return static_fault(law)

    def coefficient(law, v: float) -> float:
        """Return the friction coefficient at slip speed `v` (m/s)."""
        return law.mu_inf + (law.mu_0 - law.mu_inf) * exp(-v / law.v_f)

    def slope(law, v: float) -> float:
        """Return d(coefficient)/dv at slip speed `v` (m/s), in s/m."""
        return (law.mu_inf - law.mu_0) / law.v_f * exp(-v / law.v_f)
