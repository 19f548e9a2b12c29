"""Friction and its derivatives for the smooth solver, by the type of law.

One call returns friction and its derivatives, and writes the rates of the states to arrays.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from stiction.friction.law import Vector, states
from stiction.solver.compilation.jit import entry_by_address, inlined
from stiction.solver.compilation.pointer import caller, code_and_fields, pointee, types
from stiction.solver.compilation.stand_in import stand_in
from stiction.solver.problem import change, force, gradient, grain
from stiction.solver.regularised import Friction, friction_and_gradient
from stiction.solver.smooth.workspace import TRIAL, Workspace

FINEST_GRAIN = 1e-300  # m/s
INCREMENT = 1.5e-8  # of a difference: the root of the rounding error

State = tuple[float, ...]


class PointedSmoothLaw(NamedTuple):
    """A law in the form that the smooth solver calls: compiled functions, and its fields.

    Parameters
    ----------
    code, grain_code : int
        Addresses of `friction_and_changes_at` (without states, `friction_at`) and `grain_at`,
        compiled for this law.
    fields : ndarray
        Memory with the law's fields.
    unitless : ndarray of bool
        Whether the quantity in a column has no unit, for slip x, y and the internal states.
    """

    code: int
    grain_code: int
    fields: np.ndarray
    unitless: np.ndarray


class Place(NamedTuple):
    """The arguments of a law: slip (m/s), load (N), 1/mass, internal states; and the row."""

    slip: Vector
    load: float
    per_mass: float
    z: State
    i: int


class LawRows(NamedTuple):
    """The arrays of a workspace that a law with states reads and writes; see `Workspace`."""

    values: np.ndarray
    changes: np.ndarray
    jacobian: np.ndarray
    size: np.ndarray


def point_to_smooth_law(law: Any) -> PointedSmoothLaw:
    """Return a law in the form that the smooth solver calls."""
    plain = np.array([True, True, *(state.unit == "1" for state in states(law))])
    own = friction_and_changes_at if states(law) else friction_at
    code, grain_code, fields = code_and_fields(law, own, grain_at)
    return PointedSmoothLaw(code, grain_code, fields, plain)


@inlined
def friction_and_changes(
    law: PointedSmoothLaw,
    slip: Vector,
    load: float,
    per_mass: float,
    w: Workspace,
    i: int,
    wanted: bool,
) -> Friction:
    """Return friction over mass and, on request, its derivatives by slip.

    Parameters
    ----------
    slip, load, per_mass
        m/s, N, 1/kg.
    w : Workspace
        Row `i` of the values holds the internal states. Their rates of change, and the derivatives
        of these and of friction, are written to the rows `i` of changes and jacobian.
    """
    found: Friction
    if w.size.shape[0] == 2:
        found = call_friction(law.code, law.fields, (slip[0], slip[1], load, per_mass))
    else:
        found = call_with_states(
            law.code,
            law.fields,
            (slip[0], slip[1], load, per_mass, wanted, i, w.values, w.changes, w.jacobian, w.size),
        )
    return found


@inlined
def grain_of(law: PointedSmoothLaw, values: np.ndarray, i: int) -> float:
    """Return the slip speed below which friction is proportional to it, at the states of a row."""
    found: float = call_grain(law.grain_code, law.fields, (values, i))
    return found


ROWS, SQUARES = types.float64[:, ::1], types.float64[:, :, ::1]
FRICTION = (types.float64,) * 4
WITH_STATES = (*FRICTION, types.boolean, types.intp, ROWS, ROWS, SQUARES, types.float64[::1])
GRAIN = (ROWS, types.intp)
FOUND = types.UniTuple(types.float64, 6)
call_friction: Any = caller(FOUND, *FRICTION)
call_with_states: Any = caller(FOUND, *WITH_STATES)
call_grain: Any = caller(types.float64, *GRAIN)


@entry_by_address(*FRICTION)
def friction_at(law: Any, s_x: float, s_y: float, load: float, per_mass: float) -> Friction:
    """Do the work of `friction_and_changes` for the law without states at a pointer."""
    f, g, xx, xy, yx, yy = friction_and_gradient(pointee(law), (s_x, s_y), load)
    m = per_mass
    return f * m, g * m, xx * m, xy * m, yx * m, yy * m


@entry_by_address(*WITH_STATES)
def friction_and_changes_at(
    law: Any,
    s_x: float,
    s_y: float,
    load: float,
    per_mass: float,
    wanted: bool,
    i: int,
    values: np.ndarray,
    changes: np.ndarray,
    jacobian: np.ndarray,
    size: np.ndarray,
) -> Friction:
    """Do the work of `friction_and_changes` for the law with states at a pointer."""
    found: Any = pointee(law)
    at = Place((s_x, s_y), load, per_mass, states_in(found, values, i), i)
    rows = LawRows(values, changes, jacobian, size)
    write_changes(found, at, rows)
    if wanted:
        write_gradient(found, at, rows)
    m = jacobian[i]
    return changes[i, 0], changes[i, 1], m[0, 0], m[0, 1], m[1, 0], m[1, 1]


@entry_by_address(*GRAIN)
def grain_at(law: Any, values: np.ndarray, i: int) -> float:
    """Do the work of `grain_of` for the law at a pointer."""
    found: Any = pointee(law)
    return max(grain(found, states_in(found, values, i)), FINEST_GRAIN)


def write_changes(law: Any, at: Place, rows: LawRows) -> None:
    """Write friction over mass and the internal states' rates of change to a row."""
    rows.changes[at.i, :2] = np.array(force(law, at.slip, at.load, at.z)) * at.per_mass
    rows.changes[at.i, 2:] = change(law, at.slip, at.load, at.z)


def write_gradient(law: Any, at: Place, rows: LawRows) -> None:
    """Write the derivatives of ``changes[i]`` to ``jacobian[i]``.

    They are the law's own, or forward differences.
    """
    write = own_gradient if hasattr(law, "gradient") else differences
    write(law, at, rows)


def own_gradient(law: Any, at: Place, rows: LawRows) -> None:
    """Do the work of `write_gradient` for a law that provides its derivatives."""
    own = gradient(law, at.slip, at.load, at.z)
    for j in range(len(rows.size)):
        for k in range(len(rows.size)):
            rows.jacobian[at.i, j, k] = own[j][k] * at.per_mass if j < 2 else own[j][k]


def differences(law: Any, at: Place, rows: LawRows) -> None:
    """Do the work of `write_gradient` for other laws, by finite differences."""
    i, trial, changes = at.i, rows.values[TRIAL], rows.changes
    for k in range(len(rows.size)):  # not trial[:] = values[i]: see `smooth.loop.keep`
        trial[k] = rows.values[i, k]
    trial[0], trial[1] = at.slip
    for k in range(len(rows.size)):
        before = trial[k]
        trial[k] = before + INCREMENT * (rows.size[k] + abs(before))
        per = 1.0 / (trial[k] - before)
        z = states_in(law, rows.values, TRIAL)
        write_changes(law, Place((trial[0], trial[1]), at.load, at.per_mass, z, TRIAL), rows)
        for j in range(len(rows.size)):
            rows.jacobian[i, j, k] = (changes[TRIAL, j] - changes[i, j]) * per
        trial[k] = before


def states_in(law: Any, values: np.ndarray, i: int) -> tuple[float, ...]:
    """Return the law's internal states in row `i`."""
    return tuple(values[i, 2:])


def _states(n: int) -> Callable[..., Any]:
    """Return a compiled function that makes a tuple of the n states in a row."""
    if n == 0:
        return inlined(lambda values, i: ())
    before, last = _states(n - 1), n + 1
    return inlined(
        lambda values, i: before(values, i) + (values[i, last],)  # noqa: RUF005
    )


def _count(law: Any) -> int:
    return len(getattr(law.instance_class, "states", tuple)())


@stand_in(states_in)
def _states_in(law: Any, values: Any, i: Any) -> Callable[..., Any]:
    found = _states(_count(law))
    return lambda law, values, i: found(values, i)


@stand_in(write_changes)
def _write_changes(law: Any, at: Any, rows: Any) -> Callable[..., None]:
    n = _count(law)

    def write(law: Any, at: Any, rows: Any) -> None:
        f, to = force(law, at.slip, at.load, at.z), rows.changes[at.i]
        to[0], to[1] = f[0] * at.per_mass, f[1] * at.per_mass
        dz = change(law, at.slip, at.load, at.z)
        for k in range(n):
            to[2 + k] = dz[k]

    return write


@stand_in(write_gradient, forceinline=True)  # a law's own shares logarithms with the force
def _write_gradient(law: Any, *_: Any) -> Callable[..., None]:
    return own_gradient if hasattr(law.instance_class, "gradient") else differences
