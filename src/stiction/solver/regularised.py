"""Set-valued friction laws made smooth, and their derivatives by the slip velocity."""

from __future__ import annotations

from math import atan, pi, sqrt
from typing import Any, NamedTuple

import numpy as np

from stiction.arrays import Floats
from stiction.friction.law import Vector
from stiction.solver.compilation.stand_in import called_from_both
from stiction.solver.problem import Elliptic, Isotropic, Problem, by_type, coefficient_and_slope

# friction x and y, and their derivatives by slip: xx, xy, yx, yy
Friction = tuple[float, float, float, float, float, float]

SERIES = 1e-3  # of delta: below, two terms of a series, whose next one is of the order x^4


class Smoothed(NamedTuple):
    """F N s/sqrt(s.N s + delta^2) (M60): a set-valued law F without its jump at zero slip.

    Parameters
    ----------
    law : FrictionLaw
        The set-valued law.
    surface : Isotropic or Elliptic
        The tensor N, see `stiction.solver.surface`; 1 for an isotropic surface.
    delta : float
        m/s.
    """

    law: Any
    surface: Isotropic | Elliptic
    delta: float

    def slip_factor(self, square: float) -> tuple[float, float]:
        """Return h(q) and -h'/(q h), where h turns a slip s into friction, for q^2."""
        h = 1.0 / sqrt(square + self.delta * self.delta)
        return h, h * h

    def force(self, slip: Vector, load: float, state: tuple[float, ...]) -> Vector:
        """Return the friction force (N)."""
        f = friction_and_gradient(self, slip, load)
        return f[0], f[1]

    def grain(self, state: tuple[float, ...]) -> float:
        """Return delta: friction is proportional, or nearly so, to the slip velocity below."""
        return self.delta


class SmoothedByArctan(Smoothed):
    """F N s/q (2/pi) atan(q/delta), q^2 = s.N s: as `Smoothed`, by the arc tangent.

    Leine et al., Nonlinear Dynamics 16 (1998), 41, doi:10.1023/A:1008289604683. It approaches F as
    delta/q only, (M60) as its square.
    """

    __slots__ = ()

    def slip_factor(self, square: float) -> tuple[float, float]:
        """Return h = (2/pi) atan(q/delta)/q and -h'/(q h), for q^2; a series where q is small."""
        x = sqrt(square) / self.delta
        if x < SERIES:
            h = 2.0 / (pi * self.delta) * (1.0 - x * x / 3.0)
            return h, (2.0 / 3.0 - (4.0 / 5.0 - 2.0 / 9.0) * x * x) / (self.delta * self.delta)
        share = atan(x) / x
        h = 2.0 / (pi * self.delta) * share
        return h, (share - 1.0 / (1.0 + x * x)) / (share * square)


SMOOTHED: dict[str, Any] = {"root": Smoothed, "arctan": SmoothedByArctan}


@by_type
def slip_factor(law: Smoothed, square: float) -> tuple[float, float]:
    """Return h(q) and -h'/(q h), where h turns a slip s into friction, for q^2."""
    return law.slip_factor(square)


@called_from_both
def friction_and_gradient(law: Smoothed, slip: Vector, load: float) -> Friction:
    """Return mu(v) W h N s (N) and its derivatives by the slip velocity (N s/m)."""
    x, y = slip
    n = law.surface
    n_x, n_y = n.xx * x + n.xy * y, n.xy * x + n.yy * y
    v, (per, fall) = sqrt(x * x + y * y), slip_factor(law, x * n_x + y * n_y)
    mu, slope = coefficient_and_slope(law.law, v)
    f, along = mu * load * per, slope * load * per / v if v > 0.0 else 0.0
    # d(f n)/ds, n = N s: f N + n (mu'/mu s/v + n h'/(q h)) f
    turn = f * fall
    by_x, by_y = along * x - turn * n_x, along * y - turn * n_y
    return (
        f * n_x,
        f * n_y,
        f * n.xx + n_x * by_x,
        f * n.xy + n_x * by_y,
        f * n.xy + n_y * by_x,
        f * n.yy + n_y * by_y,
    )


def gradient_in_axes(law: Smoothed, problem: Problem, slip: Vector, load: float) -> Floats:
    """Return the derivative of friction over mass by slip, (2, 2), in the solver's axes."""
    outward = problem.rig.outward
    turn = np.array([outward((1.0, 0.0)), outward((0.0, 1.0))])
    _, _, *slopes = friction_and_gradient(law, outward(slip), load)
    turned: Floats = turn @ np.reshape(slopes, (2, 2)) @ turn.T
    return turned * problem.system.per_mass
