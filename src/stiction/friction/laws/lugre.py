"""The LuGre model: bristles that bend and slip."""

from __future__ import annotations

from math import exp, sqrt
from typing import NamedTuple, Self

from stiction.friction.law import Internal, Vector
from stiction.friction.registry import called_by_laws, register
from stiction.text.units import Damping, PositiveNumber, PositiveSpeed, Stiffness
from stiction.text.validation import validate

BRISTLES = (
    Internal("z_x", "m", "bristle deflection along x"),
    Internal("z_y", "m", "bristle deflection along y"),
)


@register("lugre")
@validate
class LuGre(NamedTuple):
    """The LuGre model (Canudas de Wit et al. 1995, doi:10.1109/9.376053), in two dimensions.

        F = sigma_0 z + sigma_1 z' + sigma_2 s,   z' = s - sigma_0 |s| z/g,
        g = W [mu_c + (mu_s - mu_c) exp(-(v/v_s)^2)],   v = |s|

    z is the mean deflection of bristles, a vector in the plane like the slip velocity s
    (isotropic case of Velenis, Tsiotras, Canudas de Wit & Sorine 2005,
    doi:10.1080/00423110412331290464); its components are the internal states ``z_x``, ``z_y`` in
    results. In steady sliding F = g + sigma_2 v along s.

    Parameters
    ----------
    mu_c, mu_s : float
        Coulomb and static friction coefficient.
    v_s : float or str
        Stribeck speed, over which mu_s falls to mu_c, m/s.
    sigma_0 : float or str
        Stiffness of the bristles, N/m; 1e5 in the original paper, for forces of about 1 N.
    sigma_1 : float or str
        Damping constant of the bristles, N s/m; the root of sigma_0 in the original paper.
    sigma_2 : float or str, optional
        Viscous friction, N s/m.

    Examples
    --------
    >>> import stiction as st
    >>> law = st.laws.LuGre(
    ...     mu_c=0.15, mu_s=0.2, v_s="10 mm/s", sigma_0="100 kN/m", sigma_1="300 N s/m")
    >>> law.coefficient(0.0)
    0.2
    """

    mu_c: PositiveNumber
    mu_s: PositiveNumber
    v_s: PositiveSpeed
    sigma_0: Stiffness
    sigma_1: Damping
    sigma_2: Damping = 0.0

    @classmethod
    def like(cls, static: float, kinetic: float, speed: float) -> Self:
        """Return the law with these coefficients and this speed, and the paper's bristles."""
        return cls(kinetic, static, speed, 1e5, 1e5**0.5)

    @staticmethod
    def states() -> tuple[Internal, ...]:
        """Return the deflection of the bristles."""
        return BRISTLES

    def coefficient(law, v: float) -> float:
        """Return g/W at slip speed `v` (m/s), without viscous friction, which ignores the load."""
        x = v / law.v_s
        return law.mu_c + (law.mu_s - law.mu_c) * exp(-x * x)

    def settled(law, speed: float) -> tuple[float, ...]:
        """Return zero deflection."""
        return (0.0, 0.0)

    def force(law, slip: Vector, load: float, state: tuple[float, ...]) -> Vector:
        """Return the friction force (N)."""
        give = bending(law, slip[0], slip[1], load)
        return bristle_force(law.sigma_0, law.sigma_1, law.sigma_2, slip, give, state)

    def change(law, slip: Vector, load: float, state: tuple[float, ...]) -> tuple[float, ...]:
        """Return the rate of deflection (m/s)."""
        (s_x, s_y), (z_x, z_y) = slip, state
        give = bending(law, s_x, s_y, load)
        return s_x - give * z_x, s_y - give * z_y

    def gradient(
        law, slip: Vector, load: float, state: tuple[float, ...]
    ) -> tuple[tuple[float, ...], ...]:
        """Return the derivatives of force and change by slip x, y and the deflection."""
        give = bending(law, slip[0], slip[1], load)
        by = bending_gradient(law, slip[0], slip[1], load)
        return bristle_gradient(law.sigma_0, law.sigma_1, law.sigma_2, give, by, state)


@called_by_laws
def bristle_force(
    sigma_0: float, sigma_1: float, sigma_2: float, slip: Vector, give: float, z: tuple[float, ...]
) -> Vector:
    """Return sigma_0 z + sigma_1 z' + sigma_2 s for bristles that slip at the rate `give` (1/s)."""
    (s_x, s_y), (z_x, z_y) = slip, z
    return (
        sigma_0 * z_x + sigma_1 * (s_x - give * z_x) + sigma_2 * s_x,
        sigma_0 * z_y + sigma_1 * (s_y - give * z_y) + sigma_2 * s_y,
    )


@called_by_laws
def bristle_gradient(
    sigma_0: float, sigma_1: float, sigma_2: float, give: float, by: Vector, z: tuple[float, ...]
) -> tuple[tuple[float, ...], ...]:
    """Return the derivatives of force and deflection rate, given those of `give` by the slip."""
    (by_x, by_y), (z_x, z_y) = by, z
    xx, xy, yx, yy = 1.0 - by_x * z_x, -by_y * z_x, -by_x * z_y, 1.0 - by_y * z_y
    by_z = sigma_0 - sigma_1 * give
    return (
        (sigma_1 * xx + sigma_2, sigma_1 * xy, by_z, 0.0),
        (sigma_1 * yx, sigma_1 * yy + sigma_2, 0.0, by_z),
        (xx, xy, -give, 0.0),
        (yx, yy, 0.0, -give),
    )


@called_by_laws
def bending(law: LuGre, s_x: float, s_y: float, load: float) -> float:
    """Return sigma_0 |s|/g, the rate at which bristles slip, per second."""
    square = s_x * s_x + s_y * s_y
    narrow = 1.0 / (law.v_s * law.v_s)
    g = law.mu_c + (law.mu_s - law.mu_c) * exp(-square * narrow)
    return law.sigma_0 * sqrt(square) / (load * g)


@called_by_laws
def bending_gradient(law: LuGre, s_x: float, s_y: float, load: float) -> Vector:
    """Return the derivatives of `bending` by the slip velocity, per metre; zero at zero slip."""
    square = s_x * s_x + s_y * s_y
    if square == 0.0:
        return 0.0, 0.0
    narrow = 1.0 / (law.v_s * law.v_s)
    weakened = (law.mu_s - law.mu_c) * exp(-square * narrow)
    share = 1.0 / square + 2.0 * narrow * weakened / (law.mu_c + weakened)
    f = bending(law, s_x, s_y, load) * share
    return f * s_x, f * s_y
