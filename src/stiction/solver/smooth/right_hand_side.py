"""Forces on the mass, friction and the rates of internal states at one point in time."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from stiction.arrays import TINY
from stiction.friction.law import Vector
from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import inlined
from stiction.solver.problem import (
    Problem,
    at,
    cross_damping,
    drive_rate,
    drive_rate_change,
    drive_travel,
    inward,
    is_aligned,
    outward,
)
from stiction.solver.regularised import Friction
from stiction.solver.smooth.coordinate import slip_and_slope
from stiction.solver.smooth.dispatch import friction_and_changes
from stiction.solver.smooth.workspace import START, Workspace
from stiction.solver.stepping.block_algebra import Triple
from stiction.solver.stepping.control import motion_of
from stiction.solver.stick import holding

NOTICED = 0.01  # change of the friction coefficient that sets the scale of a state's errors


class SmoothOutset(NamedTuple):
    """A step's start: time (s), elongation (m), the speed eps of the slip coordinate (m/s).

    Then `unit`, the q below which friction is linear in it: 0 if it is the slip velocity and there
    are states, whose rates have a kink at rest. Last the share of the slip speed to which errors
    are relative: less than 1 where the motion about steady sliding is slower.
    """

    t: float
    u_x: float
    u_y: float
    eps: float
    unit: float
    share: float


class Pull(NamedTuple):
    """The forces over mass (m/s^2) at a point without slip, and the normal load (N)."""

    x: float
    y: float
    load: float


class Point(NamedTuple):
    """Slip velocity (m/s) and friction over mass (m/s^2) at a point.

    Then their derivatives by the slip coordinate q.
    """

    s_x: float
    s_y: float
    f_x: float
    f_y: float
    s_xx: float
    s_xy: float
    s_yy: float
    f_xx: float
    f_xy: float
    f_yx: float
    f_yy: float


class Stages(NamedTuple):
    """Slip velocity (m/s) and friction over mass (m/s^2) at the three stages of a step."""

    s_x: Triple
    s_y: Triple
    f_x: Triple
    f_y: Triple
    s_xx: Triple
    s_xy: Triple
    s_yy: Triple
    f_xx: Triple
    f_xy: Triple
    f_yx: Triple
    f_yy: Triple


@inlined
def pull(problem: Problem, start: SmoothOutset, dt: float) -> Pull:
    """Return the forces `dt` after the step's start for a mass without slip since then."""
    d_x, d_y = drive_travel(problem, start.t, dt)
    a_x, a_y = holding(problem, start.t + dt, start.u_x + d_x, start.u_y + d_y)
    return Pull(a_x, a_y, at(problem.load, start.t + dt))


@inlined
def evaluate(
    problem: Problem,
    eps: float,
    load: float,
    q_x: float,
    q_y: float,
    w: Workspace,
    i: int,
    wanted: bool,
) -> Point:
    """Return slip and friction at a slip coordinate and the states in row `i`.

    It computes derivatives on request, and writes the rates of the states to row `i`.
    """
    s_x, s_y, s_xx, s_xy, s_yy = slip_and_slope(eps, q_x, q_y)
    f_x, f_y, xx, xy, yx, yy = acting(problem, (s_x, s_y), load, w, i, wanted)
    return Point(
        s_x,
        s_y,
        f_x,
        f_y,
        s_xx,
        s_xy,
        s_yy,
        xx * s_xx + xy * s_xy,
        xx * s_xy + xy * s_yy,
        yx * s_xx + yy * s_xy,
        yx * s_xy + yy * s_yy,
    )


@inlined
def acting(
    problem: Problem, s: Vector, load: float, w: Workspace, i: int, wanted: bool
) -> Friction:
    """Return friction over mass and its derivatives, on a general rig with cross damping.

    There the law is asked in the axes x and y, and what it says of states and slip is turned, too.
    """
    per = problem.system.per_mass
    if is_aligned(problem.rig):
        return friction_and_changes(problem.law, s, load, per, w, i, wanted)
    f_x, f_y, xx, xy, yx, yy = friction_and_changes(
        problem.law, outward(problem.rig, s), load, per, w, i, wanted
    )
    f_x, f_y = inward(problem.rig, (f_x, f_y))
    c = cross_damping(problem.rig) * per
    if wanted:
        xx, yx = inward(problem.rig, (xx, yx))
        xy, yy = inward(problem.rig, (xy, yy))
        xx, xy = inward(problem.rig, (xx, xy))
        yx, yy = inward(problem.rig, (yx, yy))
        m = w.jacobian[i]
        for k in range(2, w.size.shape[0]):
            m[0, k], m[1, k] = inward(problem.rig, (m[0, k], m[1, k]))
            m[k, 0], m[k, 1] = inward(problem.rig, (m[k, 0], m[k, 1]))
    return f_x + c * s[1], f_y + c * s[0], xx, xy + c, yx + c, yy


@inlined
def keep_slopes(problem: Problem, at: Point, w: Workspace) -> None:
    """Write the derivatives of friction over mass by slip at a step's start to its Jacobian.

    A law without states writes none, and in the axes of a general rig they are others.
    """
    m, c = w.jacobian[START], cross_damping(problem.rig) * problem.system.per_mass
    per = 1.0 / (at.s_xx * at.s_yy - at.s_xy * at.s_xy)
    m[0, 0] = (at.f_xx * at.s_yy - at.f_xy * at.s_xy) * per
    m[0, 1] = (at.f_xy * at.s_xx - at.f_xx * at.s_xy) * per - c
    m[1, 0] = (at.f_yx * at.s_yy - at.f_yy * at.s_xy) * per - c
    m[1, 1] = (at.f_yy * at.s_xx - at.f_yx * at.s_xy) * per


@inlined
def inertia_share(
    problem: Problem, h: float, a: float, q: tuple[float, float], s: Triple, f: Triple
) -> float:
    """Return the share of inertia in the resistance to a change of |q| (M69).

    `a` is the factor of the slip velocity in the equation; `s` and `f` are derivatives of slip and
    friction by q: xx, xy + yx over two, yy.
    """
    square = q[0] * q[0] + q[1] * q[1]
    if square == 0.0:
        return 1.0
    system, per = problem.system, 1.0 / square
    xx, xy, yy = q[0] * q[0] * per, q[0] * q[1] * per, q[1] * q[1] * per
    inertia = a * (xx * s[0] + 2.0 * xy * s[1] + yy * s[2])
    inertia *= 1.0 + h * (system.c_x * xx + system.c_y * yy) * system.per_mass
    friction = h * (xx * f[0] + 2.0 * xy * f[1] + yy * f[2])
    return inertia / (inertia + max(friction, 0.0) + TINY)


@inlined
def moving(
    problem: Problem, t: float, p: Pull, at_start: Point, accuracy: Accuracy
) -> tuple[float, float]:
    """Return the motion about steady sliding at a step's start (M42); see `motion_of`."""
    system, (s_x, s_y) = problem.system, (at_start.s_x, at_start.s_y)
    v_x, v_y = drive_rate(problem, t)
    g_x, g_y = drive_rate_change(problem, t)
    by_x = g_x - (p.x - system.c_x * s_x * system.per_mass - at_start.f_x)
    by_y = g_y - (p.y - system.c_y * s_y * system.per_mass - at_start.f_y)
    x, y = v_x - s_x, v_y - s_y
    return motion_of((x, y), (by_x, by_y), accuracy)


@inlined
def slowest(h: float, w: Workspace, speed: float) -> float:
    """Return the scale of the slip's error (m/s) in a step of `h`, at most `speed` (M70a).

    By slipping as fast, over the step or as long as it remembers, a state changes by its scale.
    """
    for k in range(2, w.size.shape[0]):
        of = w.jacobian[START, k]
        change = h * sqrt(of[0] * of[0] + of[1] * of[1])
        noticed = w.size[k] * (1.0 + h * abs(of[k]))
        if change * speed > noticed:
            speed = noticed / change
    return speed


@inlined
def measure(problem: Problem, load: float, w: Workspace) -> None:
    """Write the error scales of the internal states, from the row `START`.

    A scale is the state itself plus the change of it that changes the friction coefficient by
    `NOTICED`; this change counts as 1 at most if the state has no unit.
    """
    enough = NOTICED * load * problem.system.per_mass
    for k in range(2, w.size.shape[0]):
        x, y = w.jacobian[START, 0, k], w.jacobian[START, 1, k]
        effect = sqrt(x * x + y * y)
        least = enough / effect if effect > 0.0 else 1.0
        if problem.law.unitless[k]:
            least = min(1.0, least)
        w.size[k] = least + abs(w.values[START, k])
