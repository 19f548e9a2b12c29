"""The friction vector as a function of the slip direction: along it, or by an ellipse.

With N = M^2 (see `stiction.friction.Anisotropic`) friction over mass is f N e/|M e| for slip
along e, and at zero slip any a with a.N^-1 a <= f^2 (M4). In a step's axes, with slip along
(1, w), friction is f (n_1, n_2), and Eqs. (4) and (5) become

    p' = a_1 - f n_1,   p w' = a_2 - w a_1 - f tau,   tau = n_2 - w n_1,    (M12) to (M14)

The isotropic case (N = 1, tau = 0) costs nothing extra.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from stiction.solver.compilation.jit import inlined
from stiction.solver.problem import Problem, is_aligned, isotropic, metric

ROOT = 1e-15  # of 1: of the convex equation of a take-off
CLIMBED = 1e-16  # of t: a step towards it
CLIMBS = 50  # iterations


class FrictionDirection(NamedTuple):
    """Friction over f along e, the part that turns the slip, and their derivatives by w."""

    n_1: float
    tau: float
    dn_1: float
    dtau: float


class Tensor(NamedTuple):
    """A symmetric tensor, in the slider's axes or in those of a step."""

    xx: float
    xy: float
    yy: float


@inlined
def friction_direction(problem: Problem, tensor: Tensor, w: float) -> FrictionDirection:
    """Return (M12) and (M16) for slip along (1, w); `tensor` is N in the step's axes."""
    if isotropic(problem.surface):
        g = 1.0 / sqrt(1.0 + w * w)
        return FrictionDirection(g, 0.0, -w * g * g * g, 0.0)
    along, across = tensor.xx + tensor.xy * w, tensor.xy + tensor.yy * w
    per = 1.0 / sqrt(along + across * w)
    n_1, n_2 = along * per, across * per
    dn_1, dn_2 = (tensor.xy - n_1 * n_2) * per, (tensor.yy - n_2 * n_2) * per
    return FrictionDirection(n_1, n_2 - w * n_1, dn_1, dn_2 - n_1 - w * dn_1)


@inlined
def turned_into(problem: Problem, e_x: float, e_y: float) -> Tensor:
    """Return N in axes along e = (e_x, e_y) and across it."""
    if isotropic(problem.surface):
        return Tensor(1.0, 0.0, 1.0)
    return tensor_into(Tensor(problem.surface.xx, problem.surface.xy, problem.surface.yy), e_x, e_y)


@inlined
def metric_into(problem: Problem, e_x: float, e_y: float) -> Tensor:
    """Return G, |s|^2 = r.G r, in axes along e = (e_x, e_y) and across it."""
    if is_aligned(problem.rig):
        return Tensor(1.0, 0.0, 1.0)
    xx, xy, yy = metric(problem.rig)
    return tensor_into(Tensor(xx, xy, yy), e_x, e_y)


@inlined
def speed_ratio(problem: Problem, tensor: Tensor, w: float) -> float:
    """Return the slip speed over p for slip along (1, w); `tensor` is G in the step's axes."""
    if is_aligned(problem.rig):
        return sqrt(1.0 + w * w)
    return sqrt(tensor.xx + (2.0 * tensor.xy + tensor.yy * w) * w)


@inlined
def tensor_into(tensor: Tensor, e_x: float, e_y: float) -> Tensor:
    """Return a tensor in axes along e = (e_x, e_y) and across it."""
    xx, xy, yy = tensor
    return Tensor(
        xx * e_x * e_x + 2.0 * xy * e_x * e_y + yy * e_y * e_y,
        (yy - xx) * e_x * e_y + xy * (e_x * e_x - e_y * e_y),
        yy * e_x * e_x - 2.0 * xy * e_x * e_y + xx * e_y * e_y,
    )


@inlined
def friction_along(problem: Problem, e_x: float, e_y: float) -> tuple[float, float]:
    """Return the friction vector over f for slip along the unit vector e, N e/|M e|."""
    if isotropic(problem.surface):
        return e_x, e_y
    n = problem.surface
    x, y = n.xx * e_x + n.xy * e_y, n.xy * e_x + n.yy * e_y
    per = 1.0 / sqrt(x * e_x + y * e_y)
    return x * per, y * per


@inlined
def held_product(problem: Problem, a: tuple[float, float], b: tuple[float, float]) -> float:
    """Return a.N^-1 b: friction can hold a while a.N^-1 a <= f^2."""
    if isotropic(problem.surface):
        return a[0] * b[0] + a[1] * b[1]
    n = problem.surface
    mixed = a[0] * b[1] + a[1] * b[0]
    return (n.yy * a[0] * b[0] - n.xy * mixed + n.xx * a[1] * b[1]) / (n.xx * n.yy - n.xy * n.xy)


@inlined
def takeoff(problem: Problem, a: tuple[float, float], f: float) -> tuple[float, float]:
    """Return a vector along which slip starts when a exceeds the friction limit f (M18).

    The remainder, a - f N e/|M e|, accelerates along e; so f N e/|M e| is the point of the ellipse
    nearest to a, and e is along y = (f^2 N + t)^-1 a with f^2 y.N y = 1. The left-hand side is
    convex and falls with t: Newton's method from t = 0 climbs to the root.
    """
    if isotropic(problem.surface):
        return a
    n, t = problem.surface, 0.0
    y = a
    for _ in range(CLIMBS):
        xx, xy, yy = f * f * n.xx + t, f * f * n.xy, f * f * n.yy + t
        per = 1.0 / (xx * yy - xy * xy)
        y = (yy * a[0] - xy * a[1]) * per, (xx * a[1] - xy * a[0]) * per
        stress = f * f * (n.xx * y[0] + n.xy * y[1]), f * f * (n.xy * y[0] + n.yy * y[1])
        excess = stress[0] * y[0] + stress[1] * y[1] - 1.0
        if excess < ROOT:
            break
        change = (stress[0] * (yy * y[0] - xy * y[1]) + stress[1] * (xx * y[1] - xy * y[0])) * per
        step = 0.5 * excess / change
        t += step
        if step <= CLIMBED * t:
            break
    return y
