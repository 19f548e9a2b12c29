"""Constant friction."""

from __future__ import annotations

from typing import NamedTuple

from stiction.units import Coefficient
from stiction.validation import validated


@validated
class Coulomb(NamedTuple):
    """Constant friction coefficient: F = mu_0 W at any slip speed (Amontons, Coulomb).

    Parameters
    ----------
    mu_0 : float
        Friction coefficient.
    """

    mu_0: Coefficient

    def coefficient(law, v: float) -> float:
        """Return mu_0."""
        return law.mu_0

    def slope(law, v: float) -> float:
        """Return zero."""
        return 0.0
