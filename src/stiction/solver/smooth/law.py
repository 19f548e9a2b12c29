"""What the smooth solver asks of a law, by the law's type; a set-valued law made smooth."""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from typing import Any, NamedTuple

import numpy as np
from numba.extending import overload, register_jitable

from stiction.friction.law import Vector, states
from stiction.solver.compilation.interrupt import uninterrupted
from stiction.solver.compilation.jit import compiled, inlined
from stiction.solver.compilation.pointer import address, caller, memory, pointee, types
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


class PointedFlow(NamedTuple):
    """A law as the smooth solver takes it: compiled functions, and its fields.

    Parameters
    ----------
    flow_code, grain_code : int
        Addresses of `flow_at` and `grain_at`, compiled for this law.
    fields : ndarray
        Memory with the law's fields.
    unitless : ndarray of bool
        Whether what stands in a column has no unit, for slip x, y and the internal states.
    """

    flow_code: int
    grain_code: int
    fields: np.ndarray
    unitless: np.ndarray


def pointed(law: Any) -> PointedFlow:
    """Return a law as the smooth solver takes it."""
    plain = np.array([True, True, *(state.unit == "1" for state in states(law))])
    with uninterrupted():
        flows, grains = address(flow_at, law, *FLOW), address(grain_at, law, *GRAIN)
        return PointedFlow(flows, grains, memory(law), plain)


@inlined
def flow(
    law: PointedFlow,
    slip: Vector,
    load: float,
    per_mass: float,
    values: np.ndarray,
    i: int,
    to: np.ndarray,
) -> None:
    """Write friction over mass and the internal states' rates of change to ``to[i]``.

    Parameters
    ----------
    slip, load, per_mass
        m/s, N, 1/kg.
    values : ndarray
        Rows of slip velocity (x, y) and internal states; row `i` has the states.
    """
    call_flow(law.flow_code, law.fields, (slip[0], slip[1], load, per_mass, values, i, to))


@inlined
def grain_of(law: PointedFlow, values: np.ndarray, i: int) -> float:
    """Return the slip speed below which friction is proportional to it, at a row's states."""
    found: float = call_grain(law.grain_code, law.fields, (values, i))
    return found


ROWS = types.float64[:, ::1]
FLOW = (*(types.float64,) * 4, ROWS, types.intp, ROWS)
GRAIN = (ROWS, types.intp)
call_flow: Any = caller(types.none, *FLOW)
call_grain: Any = caller(types.float64, *GRAIN)


@compiled
def flow_at(
    law: Any,
    s_x: float,
    s_y: float,
    load: float,
    per_mass: float,
    values: np.ndarray,
    i: int,
    to: np.ndarray,
) -> None:
    """Do as `flow` for the law at a pointer."""
    found: Any = pointee(law)
    write_flow(found, (s_x, s_y), load, per_mass, values, i, to)


@compiled
def grain_at(law: Any, values: np.ndarray, i: int) -> float:
    """Do as `grain_of` for the law at a pointer."""
    found: Any = pointee(law)
    return max(grain(found, states_in(found, values, i)), FINEST)


def write_flow(
    law: Any, slip: Vector, load: float, per_mass: float, values: np.ndarray, i: int, to: np.ndarray
) -> None:
    """Write friction over mass and the internal states' rates of change to ``to[i]``."""
    z = states_in(law, values, i)
    to[i, :2] = np.array(force(law, slip, load, z)) * per_mass
    to[i, 2:] = change(law, slip, load, z) if z else ()


def states_in(law: Any, values: np.ndarray, i: int) -> tuple[float, ...]:
    """Return the law's internal states in row `i`."""
    return tuple(values[i, 2:])


def _states(n: int) -> Callable[..., Any]:
    """Return a compiled function that makes a tuple of the n states in a row."""
    if n == 0:
        return register_jitable(lambda values, i: ())
    before, last = _states(n - 1), n + 1
    return register_jitable(
        lambda values, i: before(values, i) + (values[i, last],)  # noqa: RUF005
    )


@overload(states_in, strict=False)
def _states_in(law: Any, values: Any, i: Any) -> Callable[..., Any]:
    found = _states(len(getattr(law.instance_class, "states", tuple)()))
    return lambda law, values, i: found(values, i)


@overload(write_flow, strict=False)
def _write_flow(
    law: Any, slip: Any, load: Any, per_mass: Any, values: Any, i: Any, to: Any
) -> Callable[..., None]:
    n = len(getattr(law.instance_class, "states", tuple)())

    def without(
        law: Any, slip: Any, load: Any, per_mass: Any, values: Any, i: Any, to: Any
    ) -> None:
        f = force(law, slip, load, ())
        to[i, 0], to[i, 1] = f[0] * per_mass, f[1] * per_mass

    def within(law: Any, slip: Any, load: Any, per_mass: Any, values: Any, i: Any, to: Any) -> None:
        z = states_in(law, values, i)
        f = force(law, slip, load, z)
        to[i, 0], to[i, 1] = f[0] * per_mass, f[1] * per_mass
        dz = change(law, slip, load, z)
        for k in range(n):
            to[i, 2 + k] = dz[k]

    return within if n else without
