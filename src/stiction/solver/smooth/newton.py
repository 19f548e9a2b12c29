"""Newton's method for the collocation equations of one step."""

from __future__ import annotations

from math import inf, sqrt
from typing import NamedTuple

from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import inlined
from stiction.solver.problem import Problem
from stiction.solver.smooth.coordinate import GENTLE, damped_rise, slip_at
from stiction.solver.smooth.elimination import (
    correct_states,
    residuals_without,
    with_diagonal,
    without_states,
)
from stiction.solver.smooth.right_hand_side import (
    Point,
    Pull,
    SmoothOutset,
    Stages,
    evaluate,
    inertia_share,
    pull,
    slowest,
)
from stiction.solver.smooth.workspace import FIRST, LAST, SECOND, START, WANTED, Workspace
from stiction.solver.stepping.block_algebra import (
    Factors,
    Matrix,
    Triple,
    eliminate,
    solve_blocks,
    times,
)
from stiction.solver.stepping.control import CONTRACTS, diverging, settled
from stiction.solver.stepping.radau import A, C, D

SMOOTH_ITERATIONS = 14
FIRM = 0.01  # of the tolerance: corrections that are negligible, where states remember them
DIVERGED = 1e100  # size of a correction, whose square must not overflow
CLOSEST = 1e-14  # relative: corrections below are rounding


class Linear(NamedTuple):
    """The part of the residuals (M66) along one axis that is linear in the slip velocity.

    It is ``by_slip (s - s_0) - given``, with s_0 the slip velocity at the start.
    """

    by_slip: Matrix
    given: Triple


@inlined
def linear(h: float, k: float, c: float, s: float, a: Triple) -> Linear:
    """Return the linear part: stiffness `k` and damping `c` over mass, slip `s` at the start."""
    square, (d1, d2, d3), (a1, a2, a3), hc = h * h * k, D, A, h * c
    by_slip = (
        (d1[0] + square * a1[0] + hc, d1[1] + square * a1[1], d1[2] + square * a1[2]),
        (d2[0] + square * a2[0], d2[1] + square * a2[1] + hc, d2[2] + square * a2[2]),
        (d3[0] + square * a3[0], d3[1] + square * a3[1], d3[2] + square * a3[2] + hc),
    )
    lost = square * s, hc * s
    given = (
        h * a[0] - lost[0] * C[0] - lost[1],
        h * a[1] - lost[0] * C[1] - lost[1],
        h * a[2] - lost[0] * C[2] - lost[1],
    )
    return Linear(by_slip, given)


@inlined
def residual(part: Linear, h: float, s: Triple, start: float, f: Triple) -> Triple:
    """Return the residuals (M66) along one axis."""
    r = times(part.by_slip, (s[0] - start, s[1] - start, s[2] - start))
    g = part.given
    return r[0] - g[0] + h * f[0], r[1] - g[1] + h * f[1], r[2] - g[2] + h * f[2]


@inlined
def stages_at(
    problem: Problem,
    eps: float,
    pulls: tuple[Pull, Pull, Pull],
    q_x: Triple,
    q_y: Triple,
    w: Workspace,
    wanted: bool,
) -> Stages:
    """Return slip and friction at the stages."""
    a: Point = evaluate(problem, eps, pulls[0].load, q_x[0], q_y[0], w, FIRST, wanted)
    b: Point = evaluate(problem, eps, pulls[1].load, q_x[1], q_y[1], w, SECOND, wanted)
    c: Point = evaluate(problem, eps, pulls[2].load, q_x[2], q_y[2], w, LAST, wanted)
    return Stages(
        (a.s_x, b.s_x, c.s_x),
        (a.s_y, b.s_y, c.s_y),
        (a.f_x, b.f_x, c.f_x),
        (a.f_y, b.f_y, c.f_y),
        (a.s_xx, b.s_xx, c.s_xx),
        (a.s_xy, b.s_xy, c.s_xy),
        (a.s_yy, b.s_yy, c.s_yy),
        (a.f_xx, b.f_xx, c.f_xx),
        (a.f_xy, b.f_xy, c.f_xy),
        (a.f_yx, b.f_yx, c.f_yx),
        (a.f_yy, b.f_yy, c.f_yy),
    )


@inlined
def block(m: Matrix, by: Triple, h: float, friction: Triple) -> Matrix:
    """Return the block of one axis by one component of q (M68): inertia, springs and friction."""
    a, b, c = m
    x, y, z = by
    linear_part = (
        (a[0] * x, a[1] * y, a[2] * z),
        (b[0] * x, b[1] * y, b[2] * z),
        (c[0] * x, c[1] * y, c[2] * z),
    )
    return with_diagonal(linear_part, (h * friction[0], h * friction[1], h * friction[2]))


@inlined
def factors(h: float, x: Linear, y: Linear, at: Stages, w: Workspace) -> Factors:
    """Return the eliminated Jacobian (M68)."""
    xx = block(x.by_slip, at.s_xx, h, at.f_xx)
    xy = block(x.by_slip, at.s_xy, h, at.f_xy)
    yx = block(y.by_slip, at.s_xy, h, at.f_yx)
    yy = block(y.by_slip, at.s_yy, h, at.f_yy)
    if w.size.shape[0] > 2:
        xx, xy, yx, yy = without_states(h, at, (xx, xy, yx, yy), w)
    return eliminate(xx, xy, yx, yy)


@inlined
def shares(problem: Problem, h: float, q_x: Triple, q_y: Triple, at: Stages) -> Triple:
    """Return the share of inertia in the resistance to a change of |q|, at each stage (M69)."""
    f_mixed = (
        0.5 * (at.f_xy[0] + at.f_yx[0]),
        0.5 * (at.f_xy[1] + at.f_yx[1]),
        0.5 * (at.f_xy[2] + at.f_yx[2]),
    )
    s0, f0 = (at.s_xx[0], at.s_xy[0], at.s_yy[0]), (at.f_xx[0], f_mixed[0], at.f_yy[0])
    s1, f1 = (at.s_xx[1], at.s_xy[1], at.s_yy[1]), (at.f_xx[1], f_mixed[1], at.f_yy[1])
    s2, f2 = (at.s_xx[2], at.s_xy[2], at.s_yy[2]), (at.f_xx[2], f_mixed[2], at.f_yy[2])
    return (
        inertia_share(problem, h, D[0][0], (q_x[0], q_y[0]), s0, f0),
        inertia_share(problem, h, D[1][1], (q_x[1], q_y[1]), s1, f1),
        inertia_share(problem, h, D[2][2], (q_x[2], q_y[2]), s2, f2),
    )


class Corrected(NamedTuple):
    """The slip coordinate after a correction, and the size of the correction.

    `size` is relative to the slip speed, or to the resolved speed if that is larger; `turn` to the
    slip speed over which friction turns, which determines the error of the next iteration.
    """

    q_x: float
    q_y: float
    size: float
    turn: float


@inlined
def correct(
    start: SmoothOutset, share: float, speed: float, q_x: float, q_y: float, d_x: float, d_y: float
) -> Corrected:
    """Return q less a correction, damped by (M69) where q is logarithmic."""
    q, d = sqrt(q_x * q_x + q_y * q_y), sqrt(d_x * d_x + d_y * d_y)
    q_x, q_y = q_x - d_x, q_y - d_y
    if start.eps == inf:
        return Corrected(q_x, q_y, d / (speed + q), d / (start.unit + q))
    to = sqrt(q_x * q_x + q_y * q_y)
    if to - q > GENTLE:
        f = damped_rise(q, to - q, share) / to
        q_x, q_y = f * q_x, f * q_y
    size = d / min(1.0, start.unit + q)
    return Corrected(q_x, q_y, size, size)


@inlined
def larger(a: float, b: float) -> float:
    """Return the larger of two numbers; NaN if one is NaN."""
    return a if not a <= b else b


@inlined
def solve(
    problem: Problem,
    start: SmoothOutset,
    h: float,
    q_x: Triple,
    q_y: Triple,
    w: Workspace,
    accuracy: Accuracy,
) -> tuple[bool, int]:
    """Solve the collocation equations, starting from guesses of q and of the states in the rows.

    Returns
    -------
    converged, iterations
        The slip velocity and the states are written to the stages' rows.

    Notes
    -----
    The first Jacobian is used as long as the iteration contracts. One iteration with a fresh one
    squares the relative error, hence the test on the square of the first correction.
    """
    system, eps, states = problem.system, start.eps, w.size.shape[0] > 2
    speed = slowest(h, w, accuracy.speed)
    s_x, s_y = w.values[START, 0], w.values[START, 1]
    pulls = (
        pull(problem, start, C[0] * h),
        pull(problem, start, C[1] * h),
        pull(problem, start, C[2] * h),
    )
    per = system.per_mass
    along_x = pulls[0].x, pulls[1].x, pulls[2].x
    along_y = pulls[0].y, pulls[1].y, pulls[2].y
    x = linear(h, system.k_x * per, system.c_x * per, s_x, along_x)
    y = linear(h, system.k_y * per, system.c_y * per, s_y, along_y)
    enough = max(min(accuracy.newton, FIRM * accuracy.tolerance) * start.share, CLOSEST)
    last, fresh = 1.0, True
    at = stages_at(problem, eps, pulls, q_x, q_y, w, WANTED)
    m = factors(h, x, y, at, w)
    share = shares(problem, h, q_x, q_y, at) if eps < inf else (1.0, 1.0, 1.0)
    for iteration in range(1, SMOOTH_ITERATIONS + 1):
        r_x = residual(x, h, at.s_x, s_x, at.f_x)
        r_y = residual(y, h, at.s_y, s_y, at.f_y)
        if states:
            r_x, r_y = residuals_without(h, r_x, r_y, w)
        d_x, d_y = solve_blocks(m, r_x, r_y)
        c0 = correct(start, share[0], speed, q_x[0], q_y[0], d_x[0], d_y[0])
        c1 = correct(start, share[1], speed, q_x[1], q_y[1], d_x[1], d_y[1])
        c2 = correct(start, share[2], speed, q_x[2], q_y[2], d_x[2], d_y[2])
        q_x, q_y = (c0.q_x, c1.q_x, c2.q_x), (c0.q_y, c1.q_y, c2.q_y)
        size = larger(c2.size, larger(c1.size, c0.size))
        turn = larger(c2.turn, larger(c1.turn, c0.turn))
        if states:
            z_size = correct_states(d_x, d_y, w)
            size, turn = larger(z_size, size), larger(z_size, turn)
        if not size < DIVERGED:
            return False, iteration
        rate = turn if fresh else size / last
        if settled(size, rate, enough):
            w.values[1, 0], w.values[1, 1] = slip_at(eps, q_x[0], q_y[0])
            w.values[2, 0], w.values[2, 1] = slip_at(eps, q_x[1], q_y[1])
            w.values[3, 0], w.values[3, 1] = slip_at(eps, q_x[2], q_y[2])
            return True, iteration
        if eps == inf and diverging(iteration, size / last):
            return False, iteration
        fresh = rate > CONTRACTS
        at = stages_at(problem, eps, pulls, q_x, q_y, w, fresh)
        if fresh:
            m = factors(h, x, y, at, w)
            if eps < inf:
                share = shares(problem, h, q_x, q_y, at)
        last = size
    return False, SMOOTH_ITERATIONS
