"""The error of a step's collocation polynomial in its interior, and its scale.

The tolerance is relative to the motion about steady sliding, in which the springs keep their
length. A vibration of a micrometre at a sliding speed of a metre per second is tiny beside that
speed, and yet the only motion of interest.
"""

from __future__ import annotations

from math import inf, sqrt

from stiction.arrays import TINY
from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import inlined
from stiction.solver.exact.collocation import SlipStep, products
from stiction.solver.exact.oscillation import MOST_SQUARE, Oscillator, Swing, after, swings
from stiction.solver.exact.slip_frame import Frame, Outset, friction, pull
from stiction.solver.problem import Problem, drive_rate, drive_rate_change
from stiction.solver.stepping.block_algebra import Triple, less
from stiction.solver.stepping.control import motion_of
from stiction.solver.stepping.radau import (
    DEFECT_WEIGHT,
    INTERIOR,
    LATER,
    LATER_WEIGHT,
    C,
    cubic,
    cubic_slope,
    integral,
)
from stiction.solver.surface import friction_direction, speed_ratio

DIP_LOOKS = 6  # iterations at most in the search for the least slip


@inlined
def moving(
    problem: Problem, frame: Frame, start: Outset, accuracy: Accuracy
) -> tuple[float, float]:
    """Return the relative speed of the springs' ends at a step's start (M42), m/s.

    For an oscillation this is its amplitude, from the elongation rate u', and u'' times the time of
    a radian of each spring; see `motion_of`.
    """
    r, e_x, e_y = frame.r, frame.e_x, frame.e_y
    v_x, v_y = drive_rate(problem, frame.t)
    g_x, g_y = drive_rate_change(problem, frame.t)
    s_1, s_2 = start.a_1 - start.f, start.a_2 - start.turn
    x, y = v_x - r * e_x, v_y - r * e_y
    by_x, by_y = g_x - s_1 * e_x + s_2 * e_y, g_y - s_1 * e_y - s_2 * e_x
    return motion_of((x, y), (by_x, by_y), accuracy)


@inlined
def local_error(
    problem: Problem,
    frame: Frame,
    o: Oscillator,
    step: SlipStep,
    accuracy: Accuracy,
    motion: float,
) -> float:
    """Return the largest relative error of the collocation cubic inside the step.

    It follows from the defect at an interior point, times the step size: (M35) to (M38). In a step
    longer than an oscillation, along the slip or across it, which the cubic cannot follow, the
    defect may vanish by chance: there two points are used.
    """
    s, h = step.swing, step.h
    over = s.p_in, s.rest_in, s.slid_in
    error = error_at(problem, frame, step, over, accuracy, motion, INTERIOR, DEFECT_WEIGHT)
    if max(frame.k_11, frame.k_22) * h * h > MOST_SQUARE:
        over = superpose(o, s, h)
        later = error_at(problem, frame, step, over, accuracy, motion, LATER, LATER_WEIGHT)
        error = max(error, later)
    return error


@inlined
def superpose(o: Oscillator, s: Swing, h: float) -> Triple:
    """Return the contribution of the oscillation at the later point, zero if there is none."""
    if not swings(o, h):
        return 0.0, 0.0, 0.0
    (p, v, z), along = after(o, LATER * h), (o.level + o.x, s.p[0], s.p[1], s.p[2])
    rest = h * v - cubic_slope(along, LATER)
    return p - cubic(along, LATER), rest, z / h - integral(s.p, LATER)


@inlined
def error_at(
    problem: Problem,
    frame: Frame,
    step: SlipStep,
    over: Triple,
    accuracy: Accuracy,
    motion: float,
    c: float,
    weight: float,
) -> float:
    """Return the relative error from the defect at `c` (0 to 1), with its `weight`.

    `over` is the contribution of the oscillation there (see `Swing`). The defect of w is divided by
    the stiffness with which w follows the force (M37). The scale of errors is the slip speed, but
    at most the drive's: a rapid slip takes few steps, and its error shifts all that follows. The
    scale of w follows from it; that of each principal axis is the largest elongation rate possible
    there. No scale exceeds the motion about steady sliding (m/s; see `moving`): (M38), (M41).
    """
    _, h, p, w = step
    r, dt, (p_over, rest_over, slid_over) = frame.r, c * h, over
    along, turn = (r, p[0], p[1], p[2]), (0.0, w[0], w[1], w[2])
    p_in, w_in = cubic(along, c) + p_over, cubic(turn, c)
    dp, dw = cubic_slope(along, c), cubic_slope(turn, c)
    slid_1, slid_2 = h * (integral(p, c) + slid_over), h * integral(products(p, w), c)
    b_1, b_2, _, _ = pull(problem, frame, dt)
    a_1 = b_1 - frame.k_11 * slid_1 - frame.k_12 * slid_2 - (frame.c_11 + frame.c_12 * w_in) * p_in
    a_2 = b_2 - frame.k_12 * slid_1 - frame.k_22 * slid_2 - (frame.c_12 + frame.c_22 * w_in) * p_in
    stretch = sqrt(1.0 + w_in * w_in)
    f = friction(problem, frame.t + dt, p_in * speed_ratio(problem, frame.metric, w_in))[0]
    if p_in < 0.0:
        return inf
    n = friction_direction(problem, frame.surface, w_in)
    error_p = dp - h * (a_1 - f * n.n_1) + rest_over
    stiffness = p_in + weight * h * abs(a_1 + f * n.dtau)
    error_w = (p_in * dw - h * (a_2 - w_in * a_1 - f * n.tau)) / (stiffness + TINY)
    error_q = w_in * error_p + p_in * error_w
    e_x, e_y, size = frame.e_x, frame.e_y, p_in * stretch
    v_x, v_y = drive_rate(problem, frame.t + dt)
    v_x, v_y = v_x - p_in * (e_x - w_in * e_y), v_y - p_in * (e_y + w_in * e_x)
    speed = accuracy.speed
    slip_scale = min(size, accuracy.drive)
    scale = min(speed + slip_scale, motion)
    scale_x = min(speed + min(slip_scale, abs(v_x) + accuracy.free_x), motion)
    scale_y = min(speed + min(slip_scale, abs(v_y) + accuracy.free_y), motion)
    return weight * max(
        abs(error_p) / scale,
        abs(error_w) * (speed + size) / scale,
        abs(error_p * e_x - error_q * e_y) / scale_x,
        abs(error_p * e_y + error_q * e_x) / scale_y,
    )


@inlined
def dips(o: Oscillator, step: SlipStep, r: float, margin: float) -> bool:
    """Return whether the slip falls below a margin (m/s) inside the step and rises again.

    The search is for a zero of its rate of change, in the full slip: the oscillation plus the cubic
    superposed on it. A cubic through the slip at the stages would miss the oscillation between
    them.
    """
    if r == 0.0 or not o.v + o.drift < 0.0:  # at take-off, a fall is rounding
        return False
    s, h, p, _ = step
    laid, (q0, q1, q2) = swings(o, h), less(p, s.p)
    rest = (0.0 if laid else r, q0, q1, q2)
    left, right = 0.0, 1.0
    falls, rises = h * (o.v + o.drift), s.dp[2] + cubic_slope(rest, 1.0)
    if p[0] < p[1] >= p[2]:  # it may have risen before, and fall again
        right, rises = C[1], s.dp[1] + cubic_slope(rest, C[1])
    if not rises > 0.0:
        return False
    side = 0
    for _ in range(DIP_LOOKS):
        x = left + (right - left) * falls / (falls - rises)
        now, change = cubic(rest, x), cubic_slope(rest, x)
        if laid:
            above, rate_above, _ = after(o, x * h)
            now, change = now + above, change + h * rate_above
        if now < margin:
            return True
        # an end that stays twice gets half its weight (Illinois), for fast convergence
        if change < 0.0:
            left, falls, rises = x, change, 0.5 * rises if side < 0 else rises
            side = -1
        else:
            right, rises, falls = x, change, 0.5 * falls if side > 0 else falls
            side = 1
        # convex: the minimum lies above the tangent's value at the other end
        if now - abs(change) * (right - left) > margin:
            return False
    return False
