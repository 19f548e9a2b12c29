"""The input of the compiled solver: numbers, a law, a drive and a load.

Compiled code calls the functions below; at compile time, numba replaces each by the method of its
first argument's type. Drives and loads have three types, constant, varying and recorded, for which
the loop is specialised. A law is behind pointers (see `stiction.solver.law`), so that one loop
serves all laws.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any, NamedTuple, TypeVar

import numpy as np

from stiction.drive.recorded.spline import Recording, cubic_sum, piece_at, piece_at_one
from stiction.drive.signal import FUNCTIONS as SIGNAL_FUNCTIONS
from stiction.drive.signal import Signal
from stiction.friction import FUNCTIONS as LAW_FUNCTIONS
from stiction.friction import METHODS as LAW_METHODS
from stiction.friction import FrictionLaw, StateLaw
from stiction.friction.law import Vector, static_coefficient
from stiction.solver.compilation.jit import call_compiled, call_directly, inlined
from stiction.solver.compilation.stand_in import called_from_both, stand_in
from stiction.solver.rig import Aligned, General

EVERYWHERE = inf  # friction is smooth at any slip speed
F = TypeVar("F", bound=Callable[..., Any])


class System(NamedTuple):
    """Mass (kg), stiffnesses (N/m), dampings (N s/m) along x and y; unit vector of X; 1/mass;
    1 where an accelerated drive moves the plate, 0 where it moves the spring's end."""

    mass: float
    k_x: float
    k_y: float
    c_x: float
    c_y: float
    cos_phi: float
    sin_phi: float
    per_mass: float
    inertia: float


class Isotropic(NamedTuple):
    """An isotropic surface: the tensor N is 1."""

    xx: float = 1.0
    xy: float = 0.0
    yy: float = 1.0

    def isotropic(self) -> bool:
        """Return True: friction is along the slip."""
        return True


class Elliptic(NamedTuple):
    """A surface with an elliptic friction limit: the tensor N = M^2 in the slider's axes."""

    xx: float
    xy: float
    yy: float

    def isotropic(self) -> bool:
        """Return False: friction is not along the slip."""
        return False


class Bend(NamedTuple):
    """A bound of the second derivative of a stick's margin |a|^2 - f^2, in m^2/s^6; see `stick`.

    Drive and load are smooth all along the segment.
    """

    value: float

    def smooth_until(self, t: float, stop: float) -> float:
        """Return until when drive and load are smooth, at most `stop` (s)."""
        return stop

    def bend_after(self, t: float) -> float:
        """Return the bound that holds from time `t` until then."""
        return self.value


class Bends(NamedTuple):
    """Such bounds between the rows of recorded tables, where a derivative of drive or load jumps.

    `rows` (n + 1,) are in s; `values` (n,) hold from each row to the next.
    """

    rows: Any
    values: Any

    def smooth_until(self, t: float, stop: float) -> float:
        """Return until when drive and load are smooth, at most `stop` (s)."""
        i = int(np.searchsorted(self.rows, t, side="right"))
        return min(stop, self.rows[i]) if i < len(self.rows) else stop

    def bend_after(self, t: float) -> float:
        """Return the bound that holds from time `t` until then."""
        i = int(np.searchsorted(self.rows, t, side="right"))
        return float(self.values[min(max(i, 1), len(self.values)) - 1])


class Problem(NamedTuple):
    """Everything that determines the motion in a segment of time.

    `drive` and `load` are stretches (see `stiction.drive.signal`), `bend` says how far they are
    smooth. On a general `rig` the system and the surface are those in the solver's axes.
    """

    system: System
    law: Any
    surface: Isotropic | Elliptic
    drive: Any
    load: Any
    bend: Bend | Bends
    rig: Aligned | General = Aligned()


def kinds_of(problem: Problem) -> tuple[Any, ...]:
    """Return the types for which the compiled code is specialised."""
    kinds = (type(part) for part in (*problem.drive, *problem.load))
    return type(problem.surface), type(problem.drive), type(problem.load), type(problem.rig), *kinds


def call_for(problem: Problem, function: Any, *arguments: Any) -> Any:
    """Call a compiled function with arguments whose types follow from the problem's.

    The tables of a recording may be arrays of any order; then numba looks at them in each call.
    """
    kinds = kinds_of(problem)
    call = call_compiled if Recording in kinds else call_directly
    return call(function, kinds, *arguments)


def by_type(function: F, kind: type | None = None, **options: Any) -> F:
    """Make compiled code call the method of the first argument's type instead of `function`.

    If a `kind` is given, only for this type; `options` are those of the method's compilation.
    """
    name = function.__name__

    def method(*arguments: Any) -> Any:
        found = arguments[0].instance_class
        return getattr(found, name) if kind in (None, found) else None

    stand_in(function, **options)(method)
    return function


@by_type
def coefficient(law: FrictionLaw, v: float) -> float:
    """Return the friction coefficient at slip speed `v`."""
    return law.coefficient(v)


@by_type
def slope(law: FrictionLaw, v: float) -> float:
    """Return the derivative of the coefficient at slip speed `v`."""
    return law.slope(v)


def coefficient_and_slope(law: FrictionLaw, v: float) -> tuple[float, float]:
    """Return the friction coefficient and its derivative at slip speed `v`."""
    own = getattr(law, "coefficient_and_slope", None)
    return own(v) if own is not None else (law.coefficient(v), law.slope(v))


def static(law: FrictionLaw) -> float:
    """Return the largest friction coefficient at zero slip."""
    return static_coefficient(law)


@by_type
def force(law: StateLaw, slip: Vector, load: float, state: tuple[float, ...]) -> Vector:
    """Return the friction force (N) of a law with internal state."""
    return law.force(slip, load, state)


@by_type
def change(law: StateLaw, slip: Vector, load: float, state: tuple[float, ...]) -> tuple[float, ...]:
    """Return the rate of change of a law's internal states."""
    return law.change(slip, load, state)


@by_type
def gradient(
    law: Any, slip: Vector, load: float, state: tuple[float, ...]
) -> tuple[tuple[float, ...], ...]:
    """Return the derivatives of a law's force and change, if it gives them."""
    rows: tuple[tuple[float, ...], ...] = law.gradient(slip, load, state)
    return rows


def grain(law: StateLaw, state: tuple[float, ...]) -> float:
    """Return the slip speed below which friction is proportional to slip."""
    own: Callable[..., float] | None = getattr(law, "grain", None)
    return EVERYWHERE if own is None else own(state)


@by_type
def travel(drive: Any, t: float, dt: float) -> Vector:
    """Return the displacement (X, Y) of the drive from `t` to `t + dt`."""
    moved: Vector = drive.travel(t, dt)
    return moved


@by_type
def rate(drive: Any, t: float) -> Vector:
    """Return the velocity (X, Y) of the drive."""
    v: Vector = drive.rate(t)
    return v


@by_type
def rate_change(drive: Any, t: float) -> Vector:
    """Return the acceleration (X, Y) of the drive."""
    a: Vector = drive.rate_change(t)
    return a


@by_type
def rate_curve(drive: Any, t: float) -> Vector:
    """Return the rate of change of the drive's acceleration."""
    jerk: Vector = drive.rate_curve(t)
    return jerk


@by_type
def at(load: Any, t: float) -> float:
    """Return the normal load."""
    return float(load.at(t))


@by_type
def drift(load: Any, t: float) -> float:
    """Return the rate of change of the normal load."""
    return float(load.drift(t))


@by_type
def steady(drive: Any) -> bool:
    """Return whether the drive's velocity is constant, as known at compile time."""
    return bool(drive.steady())


@by_type
def constant(load: Any) -> bool:
    """Return whether the load is constant, as known at compile time."""
    return bool(load.constant())


@by_type
def smooth_until(bend: Bend | Bends, t: float, stop: float) -> float:
    """Return until when drive and load are smooth, at most `stop` (s)."""
    return bend.smooth_until(t, stop)


@by_type
def bend_after(bend: Bend | Bends, t: float) -> float:
    """Return a bound of the second derivative of the margin from time `t` until then."""
    return bend.bend_after(t)


@by_type
def isotropic(surface: Isotropic | Elliptic) -> bool:
    """Return whether friction is along the slip, as known at compile time."""
    return surface.isotropic()


@by_type
def is_aligned(rig: Aligned | General) -> bool:
    """Return whether the solver's axes are x and y, as known at compile time."""
    return rig.is_aligned()


@by_type
def outward(rig: Aligned | General, r: Vector) -> Vector:
    """Return a slip, or an elongation, in the axes x and y."""
    return rig.outward(r)


@by_type
def inward(rig: Aligned | General, force: Vector) -> Vector:
    """Return a force in the solver's axes."""
    return rig.inward(force)


@by_type
def metric(rig: Aligned | General) -> tuple[float, float, float]:
    """Return the tensor that gives the slip speed of a slip in the solver's axes."""
    return rig.metric()


@by_type
def into_axes(rig: Aligned | General, cos_phi: float, sin_phi: float, vector: Vector) -> Vector:
    """Return a laboratory vector (X, Y) in the solver's axes."""
    return rig.into_axes(cos_phi, sin_phi, vector)


@by_type
def cross_damping(rig: Aligned | General) -> float:
    """Return the damping between the solver's axes, N s/m."""
    return rig.cross_damping()


for _method in LAW_METHODS:
    by_type(_method)
for _piece in LAW_FUNCTIONS:
    called_from_both(_piece)
SEPARATE: Any = {"forceinline": False}  # of what is large and called from many places
for _method in SIGNAL_FUNCTIONS:
    by_type(_method, Signal)
    by_type(_method, Recording, **SEPARATE)
called_from_both(cubic_sum, **SEPARATE)
stand_in(piece_at, **SEPARATE)(lambda *_: piece_at_one)


@stand_in(coefficient_and_slope)
def _coefficient_and_slope(law: Any, v: Any) -> Any:
    own = getattr(law.instance_class, "coefficient_and_slope", None)
    return own or (lambda law, v: (coefficient(law, v), slope(law, v)))


@stand_in(static)
def _static(law: Any) -> Any:
    if "mu_static" in law.instance_class._fields:
        return lambda law: max(law.mu_static, coefficient(law, 0.0))
    return lambda law: coefficient(law, 0.0)


@stand_in(grain)
def _grain(law: Any, state: Any) -> Any:
    return getattr(law.instance_class, "grain", lambda law, state: EVERYWHERE)


@called_from_both
def varies(problem: Problem) -> bool:
    """Return whether drive or load vary, as known at compile time."""
    return not (steady(problem.drive) and constant(problem.load))


@inlined
def in_solver_axes(problem: Problem, vector: Vector) -> Vector:
    """Return a laboratory vector (X, Y) in the solver's axes."""
    return into_axes(problem.rig, problem.system.cos_phi, problem.system.sin_phi, vector)


@inlined
def drive_travel(problem: Problem, t: float, dt: float) -> Vector:
    """Return the displacement (m) of the drive from `t` to `t + dt`, in the solver's axes."""
    return in_solver_axes(problem, travel(problem.drive, t, dt))


@inlined
def drive_rate(problem: Problem, t: float) -> Vector:
    """Return the velocity (m/s) of the drive, in the solver's axes."""
    return in_solver_axes(problem, rate(problem.drive, t))


@inlined
def drive_rate_change(problem: Problem, t: float) -> Vector:
    """Return the acceleration (m/s^2) of the drive, in the solver's axes."""
    return in_solver_axes(problem, rate_change(problem.drive, t))


@inlined
def drive_rate_curve(problem: Problem, t: float) -> Vector:
    """Return the rate of change of the drive's acceleration (m/s^3), in the solver's axes."""
    return in_solver_axes(problem, rate_curve(problem.drive, t))


@inlined
def damping(problem: Problem, v_x: float, v_y: float) -> tuple[float, float]:
    """Return the dampers' force (N) at a velocity in the solver's axes."""
    s = problem.system
    if is_aligned(problem.rig):
        return s.c_x * v_x, s.c_y * v_y
    c = cross_damping(problem.rig)
    return s.c_x * v_x + c * v_y, c * v_x + s.c_y * v_y
