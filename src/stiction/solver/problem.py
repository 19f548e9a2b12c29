"""What the compiled solver works on: numbers, and laws and drives by their type.

The functions below are what compiled code calls; numba replaces each by the method of
the given law's, drive's or load's type when it compiles, so that the loop is
specialised for them and nothing is looked up while it runs.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from numba.extending import overload

from stiction.drive import Drive, Load
from stiction.friction import FrictionLaw
from stiction.slider import Slider
from stiction.solver.compiled import inlined


class System(NamedTuple):
    """Mass (kg), stiffnesses (N/m), dampings (N s/m) along x and y; unit vector of X; 1/mass."""

    mass: float
    k_x: float
    k_y: float
    c_x: float
    c_y: float
    cos_phi: float
    sin_phi: float
    per_mass: float


class Problem(NamedTuple):
    """Everything that determines the motion."""

    system: System
    law: FrictionLaw
    drive: Drive
    load: Load


def problem(slider: Slider) -> Problem:
    """Return what the compiled solver needs of a slider."""
    s = slider
    system = System(s.mass, s.k_x, s.k_y, s.c_x, s.c_y, *s.direction, 1.0 / s.mass)
    return Problem(system, s.law, s.motion, s.load)


def coefficient(law: FrictionLaw, v: float) -> float:
    """Return the friction coefficient at slip speed `v`."""
    return law.coefficient(v)


def slope(law: FrictionLaw, v: float) -> float:
    """Return the derivative of the coefficient at slip speed `v`."""
    return law.slope(v)


def travel(drive: Drive, t: float, dt: float) -> tuple[float, float]:
    """Return the displacement (X, Y) of the drive from `t` to `t + dt`."""
    return drive.travel(t, dt)


def rate(drive: Drive, t: float) -> tuple[float, float]:
    """Return the velocity (X, Y) of the drive."""
    return drive.rate(t)


def rate_change(drive: Drive, t: float) -> tuple[float, float]:
    """Return the acceleration (X, Y) of the drive."""
    return drive.rate_change(t)


def next_break(drive: Drive, t: float) -> float:
    """Return when the drive's velocity or its derivative next jumps."""
    return drive.next_break(t)


def at(load: Load, t: float) -> float:
    """Return the normal load."""
    return load.at(t)


def _by_type(function: Callable[..., Any]) -> None:
    """Have compiled code call the method of its first argument's type instead of `function`."""
    name = function.__name__

    def method(*arguments: Any) -> Any:
        return getattr(arguments[0].instance_class, name)

    overload(function, strict=False)(method)


for _function in (coefficient, slope, travel, rate, rate_change, next_break, at):
    _by_type(_function)


@inlined
def in_principal_axes(problem: Problem, vector: tuple[float, float]) -> tuple[float, float]:
    """Return a laboratory vector (X, Y) in the axes (x, y)."""
    c, s = problem.system.cos_phi, problem.system.sin_phi
    return vector[0] * c - vector[1] * s, vector[0] * s + vector[1] * c
