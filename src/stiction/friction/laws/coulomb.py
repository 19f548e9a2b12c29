"""Constant friction."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from stiction.friction.law import static_fault
from stiction.friction.registry import register
from stiction.text.units import Coefficient
from stiction.text.validation import validate


@register("coulomb")
@validate
class Coulomb(NamedTuple):
    """Constant friction coefficient: F = mu_0 W at any slip speed (Amontons, Coulomb).

    Parameters
    ----------
    mu_0 : float
        Friction coefficient.
    mu_static : float, optional
        Separate coefficient of static friction, not below mu_0; by default none.

    Examples
    --------
    >>> import stiction as st
    >>> st.Coulomb(mu_0=0.2).coefficient(0.1)
    0.2
    """

    mu_0: Coefficient
    mu_static: Coefficient = 0.0

    @classmethod
    def like(cls, static: float, kinetic: float, speed: float) -> Coulomb:
        """Return constant friction with a separate static coefficient."""
        return cls(min(static, kinetic), static)

    def faults(law) -> Iterator[tuple[str, str]]:
        """Yield contradictions between the parameters."""
        return static_fault(law)

    def coefficient(law, v: float) -> float:
        """Return mu_0."""
        return law.mu_0

    def slope(law, v: float) -> float:
        """Return zero."""
        return 0.0
