"""Division of a slider's drive and load into smooth stretches, which are integrated in turn.

Inside a stretch drive and load are smooth; between two stretches they may jump or bend. The solver
stops exactly there, so that it never steps over such an instant.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, hypot, inf, sin
from typing import Any, NamedTuple

from stiction.drive import Course, Loading, ahead, drive_stretches, load_stretches
from stiction.drive.signal import Signal, signal_at, signal_bounds, signal_change
from stiction.friction import Anisotropic, has_state
from stiction.friction.law import static_coefficient
from stiction.solver.problem import Elliptic, Isotropic, Problem, System
from stiction.system.slider import Slider


class Stretch(NamedTuple):
    """A problem to integrate until `end` (s); `lost` if the normal load vanishes there."""

    end: float
    problem: Problem
    lost: bool


def stretches(slider: Slider, start: float, end: float) -> Iterator[Stretch]:
    """Yield the stretches between two times (s), the last one shorter if contact is lost."""
    drives = drive_stretches(slider.motion)
    loads = load_stretches(slider.normal_load, slider.load)
    law, surface = friction_of(slider)
    system, t = system_of(slider), start
    while t < end:
        until, drive = ahead(drives, t)
        until_load, load = ahead(loads, t)
        drive, load = alike(drive, load)
        stop = min(end, until, until_load)
        lost = vanishes(load, t, stop)
        curve = 0.0
        if not (drive.steady() and load.constant()):  # otherwise a stick ends in closed form
            curve = bend(slider, system.inertia, drive, load, t, stop)
        problem = Problem(system, law, surface, drive, load, curve)
        yield Stretch(min(stop, lost), problem, lost <= stop)
        if lost <= stop:
            return
        t = stop


def alike(drive: Any, load: Any) -> tuple[Any, Any]:
    """Return a drive and a load, both as constant or both as varying types.

    The solver is then compiled for two cases instead of four; the results are the same.
    """
    if drive.steady() == load.constant():
        return drive, load
    if drive.steady():
        return Course(Signal(0.0, drive.velocity), Signal(0.0, 0.0)), load
    return drive, Loading(Signal(0.0, load.force))


def system_of(slider: Slider) -> System:
    """Return the numbers of a slider."""
    s = slider
    inertia = 1.0 if s.driven == "plate" else 0.0
    return System(s.mass, s.k_x, s.k_y, s.c_x, s.c_y, *s.direction, 1.0 / s.mass, inertia)


def friction_of(slider: Slider) -> tuple[Any, Isotropic | Elliptic]:
    """Return the law behind pointers, and the surface."""
    law: Any = slider.law
    surface: Isotropic | Elliptic = Isotropic()
    if isinstance(law, Anisotropic):
        c, s = cos(slider.phi + law.angle), sin(slider.phi + law.angle)
        square = law.ratio**2
        surface = Elliptic(c * c + square * s * s, (1 - square) * c * s, s * s + square * c * c)
        law = law.law
    return getattr(law, "prepare", lambda: law)(), surface


def speeds(slider: Slider, drive: Any, start: float, end: float) -> tuple[float, float]:
    """Return bounds of the drive velocity along x and y in a stretch (m/s)."""
    return _in_axes(slider, drive_bounds(drive, start, end)[0])


Bounds = tuple[tuple[float, float], ...]


def drive_bounds(drive: Any, start: float, end: float) -> Bounds:
    """Return bounds (X, Y) of the drive's velocity and of its first three derivatives."""
    if not isinstance(drive, Course):
        X, Y = drive.rate(start)
        return (abs(X), abs(Y)), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0)
    along, across = (signal_bounds(s, start, end) for s in drive)
    return tuple(zip(along, across, strict=True))


def load_bounds(load: Any, start: float, end: float) -> tuple[float, float, float]:
    """Return bounds of the normal load (N) and of its first two derivatives."""
    if not isinstance(load, Loading):
        return load.at(start), 0.0, 0.0
    return signal_bounds(load.force, start, end)[:3]


def fastest_swing(problem: Problem) -> float:
    """Return the largest angular frequency (rad/s) in drive and load, 0 if neither swings."""
    signals = [s for part in (problem.drive, problem.load) for s in part if isinstance(s, Signal)]
    harmonics = [(s.amplitude, s.omega) for s in signals]
    harmonics += [(s.amplitude_2, s.omega_2) for s in signals]
    return max((abs(omega) for amplitude, omega in harmonics if amplitude != 0.0), default=0.0)


def bend(slider: Slider, inertia: float, drive: Any, load: Any, start: float, end: float) -> float:
    """Return a bound of the second derivative of |a|^2 - f^2 while the slip is zero (M8).

    a is the friction over mass at zero slip, f its limit; |a| <= f.
    d^2/dt^2 = 2 |a'|^2 + 2 a.a'' - 2 f'^2 - 2 f f''. On an elliptic surface |a| is |M^-1 a|.
    """
    law: Any = slider.law
    if has_state(law):
        return 0.0
    s = slider
    v, dv, ddv, dddv = (_in_axes(s, pair) for pair in drive_bounds(drive, start, end))
    k, c = (s.k_x / s.mass, s.k_y / s.mass), (s.c_x / s.mass, s.c_y / s.mass)
    first = hypot(*(k[i] * v[i] + c[i] * dv[i] + inertia * ddv[i] for i in (0, 1)))
    second = hypot(*(k[i] * dv[i] + c[i] * ddv[i] + inertia * dddv[i] for i in (0, 1)))
    mu = static_coefficient(law) / s.mass
    f, _, ddf = (mu * bound for bound in load_bounds(load, start, end))
    weakest = min(1.0, law.ratio) if isinstance(law, Anisotropic) else 1.0
    first, second = first / weakest, second / weakest
    return 2.0 * (first * first + f * second + f * ddf)


def vanishes(load: Any, start: float, end: float) -> float:
    """Return the time at which the normal load vanishes; infinity if not before `end` (s).

    As in a stick, steps are as long as the bounds of the load's derivatives allow.
    """
    if not isinstance(load, Loading):
        return inf
    force = load.force
    curve = signal_bounds(force, start, end)[2]
    t = start
    while t < end:
        now, change = signal_at(force, t), signal_change(force, t)
        if now <= 0.0:
            return t
        # now + change dt - curve dt^2/2 > 0 before this
        root = (change * change + 2.0 * curve * now) ** 0.5
        dt = 2.0 * now / (root - change) if root > change else inf
        following = t + dt
        if following == t:
            return t
        t = following
    return inf


def _in_axes(slider: Slider, vector: tuple[float, float]) -> tuple[float, float]:
    c, s = (abs(x) for x in slider.direction)
    return vector[0] * c + vector[1] * s, vector[0] * s + vector[1] * c
