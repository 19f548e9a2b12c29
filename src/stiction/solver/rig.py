"""The axes in which the solver sees a rig: equal masses, and springs along the axes.

With a mass tensor M and slip s = T r, T^T M T = m and T^T K T = diag(k_x, k_y), Newton's law in r
is that of a slider with one mass. Friction becomes T^T F: an ellipse with N = T^T N T and the
associated flow rule, which the solver knows; only the law still asks for |s| = |T r|. Dampers
with axes of their own leave one term more, c_xy. See (M71) to (M74).

An aligned rig has one mass, and dampers along its springs: T = 1, which costs nothing.
"""

from __future__ import annotations

from typing import NamedTuple

from stiction.friction.law import Vector


class Aligned(NamedTuple):
    """A rig of one mass, with springs and dampers along x and y."""

    one: float = 1.0  # compiled code needs a field

    def is_aligned(self) -> bool:
        """Return True: the solver's axes are x and y."""
        return True

    def outward(self, r: Vector) -> Vector:
        """Return a slip, or an elongation, in the axes x and y."""
        return r

    def inward(self, force: Vector) -> Vector:
        """Return a force in the solver's axes."""
        return force

    def metric(self) -> tuple[float, float, float]:
        """Return G (xx, xy, yy): |s|^2 = r.G r."""
        return 1.0, 0.0, 1.0

    def into_axes(self, cos_phi: float, sin_phi: float, vector: Vector) -> Vector:
        """Return a laboratory vector (X, Y) in the axes x and y."""
        X, Y = vector
        return X * cos_phi - Y * sin_phi, X * sin_phi + Y * cos_phi

    def cross_damping(self) -> float:
        """Return c_xy, N s/m."""
        return 0.0


class General(NamedTuple):
    """Any planar rig: T (rows x and y), c_xy (N s/m), and T^-1 times the unit vectors of X, Y."""

    t_xx: float
    t_xy: float
    t_yx: float
    t_yy: float
    c_xy: float
    X_x: float
    X_y: float
    Y_x: float
    Y_y: float

    def is_aligned(self) -> bool:
        """Return False: the solver's axes are not x and y."""
        return False

    def outward(self, r: Vector) -> Vector:
        """Return a slip, or an elongation, in the axes x and y: T r."""
        return self.t_xx * r[0] + self.t_xy * r[1], self.t_yx * r[0] + self.t_yy * r[1]

    def inward(self, force: Vector) -> Vector:
        """Return a force in the solver's axes, T^T F."""
        x, y = force
        return self.t_xx * x + self.t_yx * y, self.t_xy * x + self.t_yy * y

    def metric(self) -> tuple[float, float, float]:
        """Return G = T^T T (xx, xy, yy): |s|^2 = r.G r."""
        return (
            self.t_xx * self.t_xx + self.t_yx * self.t_yx,
            self.t_xx * self.t_xy + self.t_yx * self.t_yy,
            self.t_xy * self.t_xy + self.t_yy * self.t_yy,
        )

    def into_axes(self, cos_phi: float, sin_phi: float, vector: Vector) -> Vector:
        """Return a laboratory vector (X, Y) in the solver's axes."""
        X, Y = vector
        return X * self.X_x + Y * self.Y_x, X * self.X_y + Y * self.Y_y

    def cross_damping(self) -> float:
        """Return c_xy, N s/m."""
        return self.c_xy


def as_general(cos_phi: float, sin_phi: float) -> General:
    """Return an aligned rig, X at an angle phi to x, as a general one."""
    return General(1.0, 0.0, 0.0, 1.0, 0.0, cos_phi, sin_phi, -sin_phi, cos_phi)
