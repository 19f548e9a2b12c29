"""The collocation equations of one step of slip, and their Jacobian.

The unknowns are p and w at the three stages (see `slip_frame`); in a step that ends in a landing,
p is zero at the last stage, and the step size takes its place.
"""

from __future__ import annotations

from typing import NamedTuple

from stiction.solver.compilation.jit import inlined
from stiction.solver.exact.oscillation import Swing
from stiction.solver.exact.slip_frame import Frame, friction, pull
from stiction.solver.problem import Problem
from stiction.solver.stepping.block_algebra import Factors, Triple, dot, eliminate
from stiction.solver.stepping.radau import FIRST, SECOND, THIRD, A, C, D
from stiction.solver.surface import FrictionDirection, friction_direction, speed_ratio


class SlipStep(NamedTuple):
    """A step of slip: the oscillation under it, its size h (s), and p (m/s) and w at its stages."""

    swing: Swing
    h: float
    p: Triple
    w: Triple


class Stage(NamedTuple):
    """Residuals of the two equations at one stage, and terms of their derivatives."""

    residual_p: float
    residual_w: float
    a_1: float
    a_2: float
    da_1: float  # change of the acceleration with the step size, at constant stages
    da_2: float
    f: float
    gradient: float
    per_p: float  # slip speed over p
    per_w: float  # half the derivative of its square by w
    direction: FrictionDirection


@inlined
def products(p: Triple, w: Triple) -> Triple:
    """Return p w: the slip velocity across the step's axis."""
    return p[0] * w[0], p[1] * w[1], p[2] * w[2]


@inlined
def stage(problem: Problem, frame: Frame, step: SlipStep, i: int) -> Stage:
    """Evaluate stage `i`, (M26) to (M29)."""
    swing, h, p, w = step
    q = products(p, w)
    cubic_1, slid_2 = dot(A[i], p), dot(A[i], q)
    slid_1, by_h = cubic_1 + swing.slid[i], cubic_1 + swing.slid_by_h[i]
    b_1, b_2, db_1, db_2 = pull(problem, frame, C[i] * h)
    da_1 = C[i] * db_1 - frame.k_11 * by_h - frame.k_12 * slid_2
    da_2 = C[i] * db_2 - frame.k_12 * by_h - frame.k_22 * slid_2
    p_i, w_i, q_i = p[i], w[i], q[i]
    a_1 = b_1 - h * (frame.k_11 * slid_1 + frame.k_12 * slid_2)
    a_2 = b_2 - h * (frame.k_12 * slid_1 + frame.k_22 * slid_2)
    a_1 -= frame.c_11 * p_i + frame.c_12 * q_i
    a_2 -= frame.c_12 * p_i + frame.c_22 * q_i
    per_p = speed_ratio(problem, frame.metric, w_i)
    per_w = frame.metric.xy + frame.metric.yy * w_i
    n = friction_direction(problem, frame.surface, w_i)
    f, gradient = friction(problem, frame.t + C[i] * h, p_i * per_p)
    dp = dot(D[i], (p[0] - frame.r, p[1] - frame.r, p[2] - frame.r))
    residual_p = dp - h * (a_1 - f * n.n_1) + swing.rest[i]
    residual_w = p_i * dot(D[i], w) - h * (a_2 - w_i * a_1 - f * n.tau)
    return Stage(residual_p, residual_w, a_1, a_2, da_1, da_2, f, gradient, per_p, per_w, n)


@inlined
def jacobian_rows(
    frame: Frame, step: SlipStep, i: int, at_i: Stage
) -> tuple[Triple, Triple, Triple, Triple]:
    """Return the derivatives of stage i's residuals (M31): p by p, p by w, w by p, w by w."""
    _, h, p, w = step
    k_11, k_12, k_22 = frame.k_11, frame.k_12, frame.k_22
    c_11, c_12, c_22 = frame.c_11, frame.c_12, frame.c_22
    p_i, w_i, a, d, n = p[i], w[i], A[i], D[i], at_i.direction
    square = h * h
    turned_1, turned_2 = k_12 - w_i * k_11, k_22 - w_i * k_12
    pp = (
        d[0] + square * a[0] * (k_11 + k_12 * w[0]),
        d[1] + square * a[1] * (k_11 + k_12 * w[1]),
        d[2] + square * a[2] * (k_11 + k_12 * w[2]),
    )
    pw = (square * a[0] * k_12 * p[0], square * a[1] * k_12 * p[1], square * a[2] * k_12 * p[2])
    wp = (
        square * a[0] * (turned_1 + turned_2 * w[0]),
        square * a[1] * (turned_1 + turned_2 * w[1]),
        square * a[2] * (turned_1 + turned_2 * w[2]),
    )
    ww = (
        p_i * d[0] + square * a[0] * turned_2 * p[0],
        p_i * d[1] + square * a[1] * turned_2 * p[1],
        p_i * d[2] + square * a[2] * turned_2 * p[2],
    )
    # terms of the stage's own unknowns: friction, damping, and the products p w', w a_1
    by_p, by_w = at_i.gradient * at_i.per_p, at_i.gradient * p_i * at_i.per_w / at_i.per_p
    own_pp = h * (by_p * n.n_1 + c_11 + c_12 * w_i)
    own_pw = h * (by_w * n.n_1 + at_i.f * n.dn_1 + c_12 * p_i)
    own_wp = dot(d, w) + h * (c_12 + c_22 * w_i - w_i * (c_11 + c_12 * w_i) + by_p * n.tau)
    own_ww = h * (at_i.a_1 + c_22 * p_i - w_i * c_12 * p_i + by_w * n.tau + at_i.f * n.dtau)
    return (
        add_to_entry(pp, i, own_pp),
        add_to_entry(pw, i, own_pw),
        add_to_entry(wp, i, own_wp),
        add_to_entry(ww, i, own_ww),
    )


@inlined
def add_to_entry(row: Triple, i: int, x: float) -> Triple:
    """Return the row with x added to its entry i."""
    return (
        row[0] + (x if i == 0 else 0.0),
        row[1] + (x if i == 1 else 0.0),
        row[2] + (x if i == 2 else 0.0),
    )


@inlined
def factors(
    frame: Frame, step: SlipStep, landing: bool, s0: Stage, s1: Stage, s2: Stage
) -> Factors:
    """Return the eliminated Jacobian at the given stages."""
    pp0, pw0, wp0, ww0 = jacobian_rows(frame, step, FIRST, s0)
    pp1, pw1, wp1, ww1 = jacobian_rows(frame, step, SECOND, s1)
    pp2, pw2, wp2, ww2 = jacobian_rows(frame, step, THIRD, s2)
    if landing:  # the last unknown is the step size
        swing, h, _, w = step
        pp0, wp0 = by_step_size(h, w[0], s0, swing.rest_by_h[0], pp0, wp0)
        pp1, wp1 = by_step_size(h, w[1], s1, swing.rest_by_h[1], pp1, wp1)
        pp2, wp2 = by_step_size(h, w[2], s2, swing.rest_by_h[2], pp2, wp2)
    return eliminate((pp0, pp1, pp2), (pw0, pw1, pw2), (wp0, wp1, wp2), (ww0, ww1, ww2))


@inlined
def by_step_size(
    h: float, w: float, s: Stage, rest: float, pp: Triple, wp: Triple
) -> tuple[Triple, Triple]:
    """Return the rows with the derivative by the step size (M44), (M45) as their last entry."""
    dp = s.f * s.direction.n_1 - s.a_1 - h * s.da_1 + rest
    dw = w * s.a_1 - s.a_2 + s.f * s.direction.tau - h * (s.da_2 - w * s.da_1)
    return (pp[0], pp[1], dp), (wp[0], wp[1], dw)
