"""A user's friction law, in a file: `own_law.toml` and `own_law.py` use it.

A function that the methods call must be decorated with `numba.njit`; keep it in this file.
"""

from math import log1p
from typing import NamedTuple

from stiction.text.units import Coefficient, PositiveSpeed


class Logarithmic(NamedTuple):
    """mu = mu_0 - b ln(1 + v/v_c): the same loss in each decade of slip speed above v_c.

    Rate-and-state friction in steady sliding (Dieterich 1979; rock, paper, wood): b some 0.01.
    """

    mu_0: Coefficient  # a plain `float` would take bare numbers only
    b: Coefficient
    v_c: PositiveSpeed

    def coefficient(law, v):
        """Friction coefficient at slip speed v (m/s)."""
        return law.mu_0 - law.b * log1p(v / law.v_c)

    def slope(law, v):
        """Its derivative (s/m)."""
        return -law.b / (law.v_c + v)
