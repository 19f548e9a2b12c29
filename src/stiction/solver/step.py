"""One accepted step of slip: prediction, collocation, error control."""

from __future__ import annotations

from math import inf, sqrt

from stiction.solver.blocks import Triple, dot
from stiction.solver.compiled import inlined
from stiction.solver.frame import Frame, Outset, friction, pull
from stiction.solver.newton import products, solve
from stiction.solver.problem import Problem, in_principal_axes, rate
from stiction.solver.radau import (
    DEFECT_WEIGHT,
    DERIVATIVE,
    INTEGRAL,
    INTERIOR,
    VALUE,
    C,
    cubic,
    step_factor,
)
from stiction.solver.state import Accuracy, Memory
from stiction.solver.surface import flow

# a step that has not succeeded after so many tries will not; 0.4^100 is beyond any float
ATTEMPTS = 100
# of the time, far below what it resolves: a boundary layer is thin, and motion goes on in it
RESOLUTION = 1e-30
LOOKED_AT = 12  # parts of a step between which the slip is looked at, where it has a minimum


@inlined
def time_to_landing(frame: Frame, start: Outset) -> float:
    """Return when the slip speed would vanish, from its first two derivatives, in s."""
    r = frame.r
    change = start.a_1 - start.f
    curvature = start.da_1 - frame.k_11 * r
    square = change * change - 2 * r * curvature
    if square <= 0.0:
        return inf
    root = sqrt(square)
    if change < 0.0:
        return 2 * r / (root - change)
    return (change + root) / -curvature if curvature < 0.0 else inf


@inlined
def predicted(frame: Frame, start: Outset, h: float, memory: Memory) -> tuple[Triple, Triple]:
    """Return a first guess of the stages (p, w)."""
    if memory.warm:
        x = h / memory.h_last
        c = (1.0 + C[0] * x, 1.0 + C[1] * x, 1.0 + C[2] * x)
        p = (cubic(memory.p, c[0]), cubic(memory.p, c[1]), cubic(memory.p, c[2]))
        w, turn = memory.w, memory.w[3]
        return p, (cubic(w, c[0]) - turn, cubic(w, c[1]) - turn, cubic(w, c[2]) - turn)
    r = frame.r
    c = (C[0] * h, C[1] * h, C[2] * h)
    change = start.a_1 - start.f
    if r == 0.0:  # take-off: |s| grows with t, or t^2, and turns with the force that held
        a, excess = 0.5 * start.da_1, max(change, 0.0)
        x = start.da_2 / (start.a_1 + excess) if start.a_1 > 0.0 else 0.0
        return (
            (excess + a * c[0]) * c[0],
            (excess + a * c[1]) * c[1],
            (excess + a * c[2]) * c[2],
        ), (x * c[0], x * c[1], x * c[2])
    p = (
        max(r + change * c[0], r * (1 - C[0])),
        max(r + change * c[1], r * (1 - C[1])),
        max(r + change * c[2], 0.1 * r),
    )
    return p, (0.0, 0.0, 0.0)


@inlined
def local_error(
    problem: Problem, frame: Frame, h: float, p: Triple, w: Triple, accuracy: Accuracy
) -> float:
    """Return the largest relative error of the collocation cubic inside the step.

    Its defect at an interior point, times the step size; that of w is divided by how stiffly
    w follows the force. Held against the slip speed, against 1 for w, and in each principal
    axis against what the elongation rate there can be.
    """
    r, dt = frame.r, INTERIOR * h
    p_in = VALUE[0] * r + VALUE[1] * p[0] + VALUE[2] * p[1] + VALUE[3] * p[2]
    w_in = VALUE[1] * w[0] + VALUE[2] * w[1] + VALUE[3] * w[2]
    dp = DERIVATIVE[0] * r + DERIVATIVE[1] * p[0] + DERIVATIVE[2] * p[1] + DERIVATIVE[3] * p[2]
    dw = DERIVATIVE[1] * w[0] + DERIVATIVE[2] * w[1] + DERIVATIVE[3] * w[2]
    slid_1, slid_2 = h * dot(INTEGRAL, p), h * dot(INTEGRAL, products(p, w))
    b_1, b_2, _, _ = pull(problem, frame, dt)
    a_1 = b_1 - frame.k_11 * slid_1 - frame.k_12 * slid_2 - (frame.c_11 + frame.c_12 * w_in) * p_in
    a_2 = b_2 - frame.k_12 * slid_1 - frame.k_22 * slid_2 - (frame.c_12 + frame.c_22 * w_in) * p_in
    stretch = sqrt(1.0 + w_in * w_in)
    f = friction(problem, frame.t + dt, p_in * stretch)[0]
    if p_in < 0.0:
        return inf
    n = flow(problem, frame.surface, w_in)
    error_p = dp - h * (a_1 - f * n.n_1)
    stiffness = p_in + DEFECT_WEIGHT * h * abs(a_1 + f * n.dtau)
    error_w = (p_in * dw - h * (a_2 - w_in * a_1 - f * n.tau)) / (stiffness + 1e-300)
    error_q = w_in * error_p + p_in * error_w
    e_x, e_y, size = frame.e_x, frame.e_y, p_in * stretch
    v_x, v_y = in_principal_axes(problem, rate(problem.drive, frame.t + dt))
    v_x, v_y = v_x - p_in * (e_x - w_in * e_y), v_y - p_in * (e_y + w_in * e_x)
    speed = accuracy.speed
    scale_x = speed + min(size, abs(v_x) + accuracy.free_x)
    scale_y = speed + min(size, abs(v_y) + accuracy.free_y)
    return DEFECT_WEIGHT * max(
        abs(error_p) / (speed + size),
        abs(error_w),
        abs(error_p * e_x - error_q * e_y) / scale_x,
        abs(error_p * e_y + error_q * e_x) / scale_y,
    )


@inlined
def dips(r: float, p: Triple, margin: float) -> bool:
    """Return whether the slip passes below a margin (m/s) inside the step and comes back.

    A slip that is as small as its error may have been zero.
    """
    if p[0] < 0.0 or p[1] < 0.0:
        return True
    if p[0] < r and (p[2] > min(p[0], p[1]) or p[2] < 0.1 * r):  # a minimum may be inside
        for i in range(1, LOOKED_AT):
            if cubic((r, p[0], p[1], p[2]), i / LOOKED_AT) < margin:
                return True
    return False


@inlined
def step(
    problem: Problem,
    frame: Frame,
    start: Outset,
    t_stop: float,
    memory: Memory,
    accuracy: Accuracy,
) -> tuple[bool, bool, float, Triple, Triple, float, int, int]:
    """Take one step of slip, as long as the tolerance and `t_stop` allow.

    Returns
    -------
    done : bool
        False if no step, however short, succeeds.
    landing : bool
        Whether the step ends at zero slip.
    h, p, w, error
        Step size (s), stages, and error over tolerance.
    rejected, iterations : int
    """
    t, h = frame.t, min(memory.h, accuracy.longest)
    until = inf if frame.r == 0.0 else time_to_landing(frame, start)
    if 0.6 * until < h < 1.4 * until:
        h = 0.6 * until  # two even steps rather than a long and a short one
    landing = h >= until
    if landing:
        h = until
    may_land = frame.r > 0.0
    rejected = iterations = 0
    warm = False
    p = w = (0.0, 0.0, 0.0)
    for _ in range(ATTEMPTS):
        if t + h >= t_stop:
            h, landing = t_stop - t, False
        elif not h > RESOLUTION * abs(t):
            break
        if not warm:
            p, w = predicted(frame, start, h, memory)
        if landing:
            p = (p[0], p[1], 0.0)
        tried, warm = h, False
        converged, p, w, h, count = solve(problem, frame, h, landing, p, w, accuracy)
        iterations += count
        if converged and landing and t + h > t_stop:
            h, landing, may_land = t_stop - t, False, False
            continue
        if converged and not landing and p[2] < 0.0 and may_land:
            h *= frame.r / (frame.r - p[2])
            p, landing, warm = (0.5 * frame.r, 0.2 * frame.r, 0.0), True, True
            continue
        factor = 0.3
        if converged and p[2] >= 0.0 and not dips(frame.r, p, 0.0):
            relative = local_error(problem, frame, h, p, w, accuracy)
            error = relative / accuracy.tolerance
            if error > 1.0:
                factor = step_factor(error, 1.0)
            elif landing or not dips(frame.r, p, relative * (accuracy.speed + frame.r)):
                return True, landing, h, p, w, error, rejected, iterations
        rejected += 1
        if landing:  # once is enough: too long a landing is approached by shorter steps
            may_land = False
        h, landing = min(h, tried) * factor if h > 0.0 else tried * factor, False
    return False, False, h, p, w, inf, rejected, iterations
