"""Mass, stiffness and damping of a slider as tensors, and the axes in which they are simplest."""

from __future__ import annotations

from functools import lru_cache
from math import atan2, copysign, cos, hypot, pi, sin, sqrt
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from stiction.arrays import Floats
from stiction.friction import ellipse

if TYPE_CHECKING:
    from stiction.system.slider import Slider

ROUND = 1e-12  # of a compliance, or rad: less is rounding
ROUNDED = 1e-15  # of a cosine or sine: at a right angle, in double precision, it is 2e-16 at most


def mass_tensor(slider: Slider) -> Floats:
    """Return the mass tensor in the axes x and y, (2, 2), kg.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020().replace(mass="1 kg", mass_y="2 kg")
    >>> mass_tensor(slider).diagonal()
    array([1., 2.])
    """
    return principal(slider.mass, mass_across(slider), slider.mass_angle - slider.turn)


def mobility_tensor(slider: Slider) -> Floats:
    """Return the inverse of the mass tensor, (2, 2), 1/kg."""
    along, across = 1.0 / slider.mass, 1.0 / mass_across(slider)
    return principal(along, across, slider.mass_angle - slider.turn)


def mass_across(slider: Slider) -> float:
    """Return the mass (kg) across its own axis."""
    return slider.mass if slider.mass_y is None else slider.mass_y


def surface_tensor(slider: Slider) -> Floats:
    """Return N = M^2 of `stiction.friction.Anisotropic` in the axes x and y, (2, 2)."""
    ratio, angle = ellipse(slider.law)
    return principal(1.0, ratio * ratio, slider.misalignment + angle)


def stiffness_tensor(slider: Slider) -> Floats:
    """Return the stiffness tensor in the axes x and y, (2, 2), N/m; these are its own axes."""
    return np.diag([slider.k_x, slider.k_y])


def stiffness_and_mass_along(slider: Slider, direction: tuple[float, float]) -> tuple[float, float]:
    """Return stiffness (N/m) and mass (kg) of a swing along a unit vector in the axes x and y.

    Examples
    --------
    >>> import stiction as st
    >>> stiffness_and_mass_along(st.presets.nakano_popov_2020(), (1.0, 0.0))
    (1000.0, 0.25)
    """
    e = np.array(direction)
    return float(e @ stiffness_tensor(slider) @ e), float(e @ mass_tensor(slider) @ e)


def damping_tensor(slider: Slider) -> Floats:
    """Return the damping tensor in the axes x and y, (2, 2), N s/m."""
    return principal(slider.c_x, slider.c_y, slider.damping_angle - slider.turn)


def unit_vector(angle: float) -> tuple[float, float]:
    """Return (cos, sin) of an angle (rad), exact at multiples of a right angle.

    Examples
    --------
    >>> unit_vector(pi / 2), unit_vector(-pi)
    ((0.0, 1.0), (-1.0, 0.0))
    """
    c, s = cos(angle), sin(angle)
    return 0.0 if abs(c) < ROUNDED else c, 0.0 if abs(s) < ROUNDED else s


def principal(along: float, across: float, angle: float) -> Floats:
    """Return the symmetric tensor with these principal values, the first at `angle` (rad) to x."""
    c, s = unit_vector(angle)
    mixed = (along - across) * c * s
    return np.array(
        [[along * c * c + across * s * s, mixed], [mixed, along * s * s + across * c * c]]
    )


def dampers_askew(slider: Slider) -> dict[str, float]:
    """Return the angle (rad) from x of each damper, by its name; none if they lie along springs.

    Examples
    --------
    >>> import stiction as st
    >>> rig = st.presets.nakano_popov_2020().replace(c_x=1.0, damping_angle="0.5 rad")
    >>> dampers_askew(rig), dampers_askew(rig.replace(c_y=1.0))
    ({'c_x': 0.5}, {})
    """
    angle = slider.damping_angle - slider.turn
    if slider.c_x == slider.c_y or abs(angle) < ROUND:
        return {}
    angles = {"c_x": angle, "c_y": angle + 0.5 * pi}
    return {name: at for name, at in angles.items() if getattr(slider, name) > 0.0}


class Axes(NamedTuple):
    """The solver's axes r, with slip s = T r: one mass m, springs along the axes (M71).

    `turn` is T, (2, 2), `mass` m (kg), `stiffness` its two stiffnesses (N/m), `damping` T^T C T.
    """

    turn: Floats
    mass: float
    stiffness: Floats
    damping: Floats

    def inward(self, vectors: Floats) -> Floats:
        """Return slips or elongations, (..., 2), in these axes: T^-1 s."""
        found: Floats = vectors @ np.linalg.inv(self.turn).T
        return found

    def outward(self, vectors: Floats) -> Floats:
        """Return slips or elongations, (..., 2), in the axes x and y: T r."""
        found: Floats = vectors @ self.turn.T
        return found

    def force_outward(self, forces: Floats) -> Floats:
        """Return forces, (..., 2), in the axes x and y: T^-T f."""
        found: Floats = forces @ np.linalg.inv(self.turn)
        return found


def solver_axes(slider: Slider) -> Axes:
    """Return the axes in which a slider has one mass and springs along the axes."""
    mass, damping = mass_tensor(slider), damping_tensor(slider)
    return _axes(mass.tobytes(), slider.k_x, slider.k_y, damping.tobytes())


@lru_cache(maxsize=64)
def _axes(mass: bytes, k_x: float, k_y: float, damping: bytes) -> Axes:
    M, C = (np.frombuffer(each).reshape(2, 2) for each in (mass, damping))
    m = sqrt(M[0, 0] * M[1, 1] - M[0, 1] ** 2)
    # the inverse root of B^2 = M/m, whose determinant is 1: (B^-2 + 1)/sqrt(trace + 2)
    inverse = np.array([[M[1, 1], -M[0, 1]], [-M[0, 1], M[0, 0]]]) / m
    root = (inverse + np.eye(2)) / sqrt(inverse[0, 0] + inverse[1, 1] + 2.0)
    own = root @ np.diag([k_x, k_y]) @ root
    half = 0.5 * (own[0, 0] - own[1, 1])
    stiff = 0.5 * (own[0, 0] + own[1, 1]) + hypot(half, own[0, 1])
    soft = k_x * k_y / stiff  # from the determinant: a difference would round it away
    angle = 0.5 * atan2(own[0, 1], half)  # of the stiff axis; the nearer one is that of x
    along_x = abs(angle) <= 0.25 * pi
    angle = angle if along_x else angle - copysign(0.5 * pi, angle)
    c, s = cos(angle), sin(angle)
    turn = root @ np.array([[c, -s], [s, c]])
    k = np.array([stiff, soft] if along_x else [soft, stiff])
    return Axes(turn, m, k, turn.T @ C @ turn)
