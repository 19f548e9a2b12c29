"""The LuGre model with friction that falls hyperbolically with slip speed."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple, Self

from stiction.friction.law import Internal, Vector
from stiction.friction.laws.lugre import BRISTLES, bristle_force, bristle_gradient
from stiction.friction.registry import called_by_laws, register
from stiction.text.units import Damping, PositiveNumber, PositiveSpeed, Stiffness
from stiction.text.validation import validate


@register("lugre-hyperbolic")
@validate
class LuGreHyperbolic(NamedTuple):
    """The LuGre model on a surface with hyperbolic weakening, in two dimensions.

        F = sigma_0 z + sigma_1 z' + sigma_2 s,   z' = s - sigma_0 |s| z/g,
        g = W mu_0/(1 + |s|/v_h)

    As `LuGre`, with the g of Leine's block on a belt (`stiction presets leine-lugre`): the smooth
    counterpart of `HyperbolicWeakening`.

    Parameters
    ----------
    mu_0 : float
        Friction coefficient at vanishing slip speed.
    v_h : float or str
        Slip speed at which the coefficient is half of mu_0, m/s.
    sigma_0 : float or str
        Stiffness of the bristles, N/m.
    sigma_1 : float or str
        Damping constant of the bristles, N s/m.
    sigma_2 : float or str, optional
        Viscous friction, N s/m.

    Examples
    --------
    >>> import stiction as st
    >>> law = st.laws.LuGreHyperbolic(
    ...     mu_0=0.4, v_h="10 mm/s", sigma_0="100 kN/m", sigma_1="300 N s/m")
    >>> law.coefficient(0.01)
    0.2
    """

    mu_0: PositiveNumber
    v_h: PositiveSpeed
    sigma_0: Stiffness
    sigma_1: Damping
    sigma_2: Damping = 0.0

    @classmethod
    def like(cls, static: float, kinetic: float, speed: float) -> Self:
        """Return the law with the coefficient `static`, a comparable slope, LuGre's bristles.

        A law that does not weaken is given weakening over speeds far beyond.
        """
        lost = max(static - kinetic, 1e-9 * static)
        return cls(static, speed * static / lost, 1e5, 1e5**0.5)

    @staticmethod
    def states() -> tuple[Internal, ...]:
        """Return the deflection of the bristles."""
        return BRISTLES

    def coefficient(law, v: float) -> float:
        """Return g/W at slip speed `v` (m/s), without viscous friction, which ignores the load."""
        return law.mu_0 / (1.0 + v / law.v_h)

    def settled(law, speed: float) -> tuple[float, ...]:
        """Return zero deflection."""
        return (0.0, 0.0)

    def force(law, slip: Vector, load: float, state: tuple[float, ...]) -> Vector:
        """Return the friction force (N)."""
        give = hyperbolic_bending(law, slip, load)
        return bristle_force(law.sigma_0, law.sigma_1, law.sigma_2, slip, give, state)

    def change(law, slip: Vector, load: float, state: tuple[float, ...]) -> tuple[float, ...]:
        """Return the rate of deflection (m/s)."""
        give = hyperbolic_bending(law, slip, load)
        return slip[0] - give * state[0], slip[1] - give * state[1]

    def gradient(
        law, slip: Vector, load: float, state: tuple[float, ...]
    ) -> tuple[tuple[float, ...], ...]:
        """Return the derivatives of force and change by slip x, y and the deflection."""
        give = hyperbolic_bending(law, slip, load)
        v, by = sqrt(slip[0] * slip[0] + slip[1] * slip[1]), (0.0, 0.0)
        if v > 0.0:
            f = law.sigma_0 / (load * law.mu_0) * (1.0 + 2.0 * v / law.v_h) / v
            by = (f * slip[0], f * slip[1])
        return bristle_gradient(law.sigma_0, law.sigma_1, law.sigma_2, give, by, state)


@called_by_laws
def hyperbolic_bending(law: LuGreHyperbolic, slip: Vector, load: float) -> float:
    """Return sigma_0 |s|/g, the rate at which bristles slip, per second."""
    v = sqrt(slip[0] * slip[0] + slip[1] * slip[1])
    return law.sigma_0 * v * (1.0 + v / law.v_h) / (load * law.mu_0)
