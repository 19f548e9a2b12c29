"""Division of time into segments of smooth drive and load, which are integrated in turn.

Inside a segment drive and load are smooth; between two segments they may jump or bend. The solver
stops exactly there, so that it never steps over such an instant.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot
from typing import Any, NamedTuple

import numpy as np

from stiction.drive import VaryingLoad, VaryingVelocity, ahead, drive_stretches, load_stretches
from stiction.drive.bounds import drive_bounds, load_bounds, row_bounds, vanishes
from stiction.drive.recorded.spline import Recording, silent
from stiction.drive.signal import Signal
from stiction.friction import Anisotropic, has_state
from stiction.friction.law import static_coefficient
from stiction.solver.problem import Bend, Bends, Elliptic, Isotropic, Problem, System
from stiction.solver.rig import Aligned, General
from stiction.system.initial import Initial
from stiction.system.slider import Slider
from stiction.system.tensors import solver_axes, surface_tensor


class Segment(NamedTuple):
    """A problem to integrate until `end` (s); `lost` if the normal load vanishes there."""

    end: float
    problem: Problem
    lost: bool


def segments(slider: Slider, start: float, end: float) -> Iterator[Segment]:
    """Yield the segments between two times (s), the last one shorter if contact is lost."""
    drives = drive_stretches(slider.motion)
    loads = load_stretches(slider.normal_load, slider.load)
    law, surface = friction_of(slider)
    system, rig, t = system_of(slider), rig_of(slider), start
    while t < end:
        until, drive = ahead(drives, t)
        until_load, load = ahead(loads, t)
        drive, load = alike(drive, load)
        stop = min(end, until, until_load)
        lost = vanishes(load, t, stop)
        bend = bend_of(slider, drive, load, t, stop)
        problem = Problem(system, law, surface, drive, load, bend, rig)
        yield Segment(min(stop, lost), problem, lost <= stop)
        if lost <= stop:
            return
        t = stop


def alike(drive: Any, load: Any) -> tuple[Any, Any]:
    """Return a drive and a load, both as constant, as varying or as recorded types.

    The solver is then compiled for three cases instead of nine; the results are the same.
    """
    if drive.steady() and load.constant():
        return drive, load
    along, across = (Signal(0.0, drive.velocity), Signal(0.0, 0.0)) if drive.steady() else drive
    force = Signal(0.0, load.force) if load.constant() else load.force
    if isinstance(along, Recording) or isinstance(force, Recording):
        along, force = _as_recorded(along), _as_recorded(force)
    return VaryingVelocity(along, across), VaryingLoad(force)


def _as_recorded(signal: Signal | Recording) -> Recording:
    return signal if isinstance(signal, Recording) else silent(signal)


def system_of(slider: Slider) -> System:
    """Return the numbers of a slider in the solver's axes."""
    s = slider
    inertia = 1.0 if s.driven == "plate" else 0.0
    if s.aligned:
        return System(s.mass, s.k_x, s.k_y, s.c_x, s.c_y, *s.direction, 1.0 / s.mass, inertia)
    axes = solver_axes(s)
    m, (k_x, k_y), (c_x, c_y) = axes.mass, axes.stiffness.tolist(), np.diag(axes.damping).tolist()
    return System(m, k_x, k_y, c_x, c_y, *s.direction, 1.0 / m, inertia)


def rig_of(slider: Slider) -> Aligned | General:
    """Return how the solver's axes lie in the axes x and y."""
    if slider.aligned:
        return Aligned()
    axes, (c, s) = solver_axes(slider), slider.direction
    drive = axes.inward(np.array([[c, s], [-s, c]]))
    numbers = (*axes.turn.ravel(), axes.damping[0, 1], *drive.ravel())
    return General(*(float(each) for each in numbers))


def begin(slider: Slider, initial: Initial) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the elongation (m) and slip (m/s) at the start, in the solver's axes."""
    u, slip = (initial.u_x, initial.u_y), initial.slip(slider)
    if slider.aligned:
        return u, slip
    (u_x, u_y), (s_x, s_y) = solver_axes(slider).inward(np.array([u, slip])).tolist()
    return (u_x, u_y), (s_x, s_y)


def surface_of(slider: Slider) -> Isotropic | Elliptic:
    """Return the surface in the axes x and y."""
    if not isinstance(slider.law, Anisotropic):
        return Isotropic()
    (along, mixed), (_, across) = surface_tensor(slider).tolist()
    return Elliptic(along, mixed, across)


def friction_of(slider: Slider) -> tuple[Any, Isotropic | Elliptic]:
    """Return the law behind pointers, and the surface in the solver's axes."""
    law: Any = slider.law
    if isinstance(law, Anisotropic):
        law = law.law
    return getattr(law, "prepare", lambda: law)(), solver_surface(slider)


def solver_surface(slider: Slider) -> Isotropic | Elliptic:
    """Return the surface in the solver's axes (M73)."""
    n = surface_of(slider)
    if slider.aligned:
        return n
    T = solver_axes(slider).turn
    N = T.T @ np.array([[n.xx, n.xy], [n.xy, n.yy]]) @ T
    return Elliptic(float(N[0, 0]), float(N[0, 1]), float(N[1, 1]))


def speeds(slider: Slider, drive: Any, start: float, end: float) -> tuple[float, float]:
    """Return bounds of the drive velocity along the solver's axes in a segment (m/s)."""
    return _in_axes(slider, drive_bounds(drive, start, end)[0])


def fastest_swing(problem: Problem) -> float:
    """Return the largest angular frequency (rad/s) in drive and load, 0 if neither swings."""
    if problem.drive.steady():  # and so is the load, see `alike`
        return 0.0
    return max(float(each.fastest()) for each in (*problem.drive, *problem.load))


def bend_of(slider: Slider, drive: Any, load: Any, start: float, end: float) -> Bend | Bends:
    """Return bounds of the second derivative of a stick's margin, between the rows of tables."""
    if drive.steady() and load.constant():  # a stick ends in closed form
        return Bend(0.0)
    if isinstance(drive.along, Recording):
        found = row_bounds(drive, load, start, end)
        values = bend(slider, found.drive, found.load)
        return Bends(found.rows, np.broadcast_to(values, len(found.rows) - 1).astype(np.float64))
    return Bend(bend(slider, drive_bounds(drive, start, end), load_bounds(load, start, end)))


def bend(slider: Slider, of_drive: Any, of_load: Any) -> Any:
    """Return a bound of the second derivative of |a|^2 - f^2 while the slip is zero (M8).

    a is the friction over mass at zero slip, f its limit; |a| <= f.
    d^2/dt^2 = 2 |a'|^2 + 2 a.a'' - 2 f'^2 - 2 f f''. On an elliptic surface |a| is |M^-1 a|.

    Parameters
    ----------
    slider : Slider
        The system.
    of_drive, of_load : tuple
        Bounds as of `drive_bounds` and `load_bounds`: floats, or arrays over the rows of tables.
    """
    law: Any = slider.law
    if has_state(law):
        return 0.0
    s, inertia = (system := system_of(slider)), system.inertia
    v, dv, ddv, dddv = (_in_axes(slider, pair) for pair in of_drive)
    k, c = (s.k_x / s.mass, s.k_y / s.mass), (s.c_x / s.mass, s.c_y / s.mass)
    mixed = abs(rig_of(slider).cross_damping()) / s.mass
    first = _length(
        *(k[i] * v[i] + c[i] * dv[i] + mixed * dv[1 - i] + inertia * ddv[i] for i in (0, 1))
    )
    second = _length(
        *(k[i] * dv[i] + c[i] * ddv[i] + mixed * ddv[1 - i] + inertia * dddv[i] for i in (0, 1))
    )
    mu = static_coefficient(law) / s.mass
    f, _, ddf = (mu * bound for bound in of_load)
    weakest = weakest_share(solver_surface(slider))
    first, second = first / weakest, second / weakest
    return 2.0 * (first * first + f * second + f * ddf)


def _length(x: Any, y: Any) -> Any:
    """Return the length of a vector, or of many."""
    return np.hypot(x, y) if isinstance(x, np.ndarray) else hypot(x, y)


def weakest_share(surface: Isotropic | Elliptic) -> float:
    """Return the shorter half-axis of the ellipse of friction over f, 1 on an isotropic surface."""
    mean, half = 0.5 * (surface.xx + surface.yy), 0.5 * (surface.xx - surface.yy)
    # the smaller eigenvalue of N as its determinant over the larger
    larger = mean + hypot(half, surface.xy)
    return float(((surface.xx * surface.yy - surface.xy**2) / larger) ** 0.5)


def _in_axes(slider: Slider, vector: tuple[Any, Any]) -> tuple[Any, Any]:
    """Return bounds along the solver's axes of a vector with these bounds along X and Y."""
    rig, (c, s) = rig_of(slider), slider.direction
    (X_x, X_y), (Y_x, Y_y) = rig.into_axes(c, s, (1.0, 0.0)), rig.into_axes(c, s, (0.0, 1.0))
    X, Y = vector
    return X * abs(X_x) + Y * abs(Y_x), X * abs(X_y) + Y * abs(Y_y)
