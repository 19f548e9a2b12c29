"""What the smooth solver asks of a law, by the law's type; a set-valued law made smooth."""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from typing import Any, NamedTuple

import numpy as np
from numba.extending import overload, register_jitable

from stiction.friction.law import Vector
from stiction.solver.problem import Elliptic, Isotropic, change, coefficient, force, grain

FINEST = 1e-300  # m/s


class Smoothed(NamedTuple):
    """F N s/sqrt(s.N s + delta^2) (M60): a set-valued law F without what happens at zero slip.

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

    def force(law, slip: Vector, load: float, state: tuple[float, ...]) -> Vector:
        """Return the friction force (N)."""
        x, y = slip
        n = law.surface
        n_x, n_y = n.xx * x + n.xy * y, n.xy * x + n.yy * y
        size = sqrt(x * n_x + y * n_y + law.delta * law.delta)
        f = coefficient(law.law, sqrt(x * x + y * y)) * load / size
        return f * n_x, f * n_y

    def grain(law, state: tuple[float, ...]) -> float:
        """Return delta: friction is proportional to the slip velocity below."""
        return law.delta


def flow(
    law: Any, slip: Vector, load: float, per_mass: float, values: np.ndarray, i: int, to: np.ndarray
) -> None:
    """Write friction over mass and the internal states' rates of change to ``to[i]``.

    Parameters
    ----------
    slip, load, per_mass
        m/s, N, 1/kg.
    values : ndarray
        Rows of slip velocity (x, y) and internal states; row `i` has the states.
    """
    z = tuple(values[i, 2:])
    to[i, :2] = np.array(force(law, slip, load, z)) * per_mass
    to[i, 2:] = change(law, slip, load, z) if z else ()


def _states(n: int) -> Callable[..., Any]:
    """Return a compiled function that makes a tuple of the n states in a row."""
    if n == 0:
        return register_jitable(lambda values, i: ())
    before, last = _states(n - 1), n + 1
    return register_jitable(
        lambda values, i: before(values, i) + (values[i, last],)  # noqa: RUF005
    )


@overload(flow, strict=False)
def _flow(
    law: Any, slip: Any, load: Any, per_mass: Any, values: Any, i: Any, to: Any
) -> Callable[..., None]:
    n = len(getattr(law.instance_class, "states", tuple)())
    states = _states(n)

    def without(
        law: Any, slip: Any, load: Any, per_mass: Any, values: Any, i: Any, to: Any
    ) -> None:
        f = force(law, slip, load, ())
        to[i, 0], to[i, 1] = f[0] * per_mass, f[1] * per_mass

    def within(law: Any, slip: Any, load: Any, per_mass: Any, values: Any, i: Any, to: Any) -> None:
        z = states(values, i)
        f = force(law, slip, load, z)
        to[i, 0], to[i, 1] = f[0] * per_mass, f[1] * per_mass
        dz = change(law, slip, load, z)
        for k in range(n):
            to[i, 2 + k] = dz[k]

    return within if n else without


def grain_at(law: Any, values: np.ndarray, i: int) -> float:
    """Return the slip speed below which friction is proportional to it, at a row's states."""
    return max(grain(law, tuple(values[i, 2:])), FINEST)


def unitless(law: Any, k: int) -> bool:
    """Return whether the internal state in column `k` of a row has no unit."""
    return bool(law.states()[k - 2].unit == "1")


@overload(unitless, strict=False)
def _unitless(law: Any, k: Any) -> Callable[..., Any]:
    given: tuple[Any, ...] = getattr(law.instance_class, "states", tuple)()
    plain = np.array([True, True, *(state[1] == "1" for state in given)])
    return lambda law, k: plain[k]


@overload(grain_at, strict=False)
def _grain_at(law: Any, values: Any, i: Any) -> Callable[..., float]:
    states = _states(len(getattr(law.instance_class, "states", tuple)()))
    return lambda law, values, i: max(grain(law, states(values, i)), FINEST)
