"""The paper's friction law: exponential weakening with slip speed."""

from __future__ import annotations

from math import exp
from typing import NamedTuple

from stiction.units import Coefficient, PositiveSpeed
from stiction.validation import validated


@validated
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
    """

    mu_0: Coefficient
    mu_inf: Coefficient
    v_f: PositiveSpeed

    def coefficient(law, v: float) -> float:
        """Return the friction coefficient at slip speed `v` (m/s)."""
        return law.mu_inf + (law.mu_0 - law.mu_inf) * exp(-v / law.v_f)

    def slope(law, v: float) -> float:
        """Return d(coefficient)/dv at slip speed `v` (m/s), in s/m."""
        return (law.mu_inf - law.mu_0) / law.v_f * exp(-v / law.v_f)
