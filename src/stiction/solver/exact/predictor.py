"""Predictions for a step of slip: the time of landing, and first guesses of the stages."""

from __future__ import annotations

from math import inf, sqrt

from stiction.solver.compilation.jit import inlined
from stiction.solver.exact.collocation import add_to_entry, products
from stiction.solver.exact.oscillation import Oscillator, Swing, after, swings
from stiction.solver.exact.slip_frame import Frame, Outset, elongation
from stiction.solver.problem import Problem
from stiction.solver.state import Memory
from stiction.solver.stepping.block_algebra import Triple, inverse, times
from stiction.solver.stepping.radau import FIRST, SECOND, THIRD, A, C, D, cubic
from stiction.solver.stick import margin

CLOSE_BY = 2.5  # step sizes: a landing so soon is looked at closely
REMAINS = 0.1  # of the slip, at the end: the least that is guessed


@inlined
def time_to_landing(frame: Frame, start: Outset, o: Oscillator, h: float) -> float:
    """Return the time to zero slip, in s; accurate only if it is comparable to `h`."""
    t = landing_of_parabola(frame, start)
    return swung_to_rest(o, t) if t < CLOSE_BY * h else t


@inlined
def landing_of_parabola(frame: Frame, start: Outset) -> float:
    """Return the time to zero slip from its first two derivatives (M47), in s."""
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
def swung_to_rest(o: Oscillator, t: float) -> float:
    """Improve the time to landing `t` by a step of Newton's method."""
    if swings(o, t):
        p, v, _ = after(o, t)
        if v < 0.0:
            return max(t - p / v, 0.5 * t)
    return t


@inlined
def passes(problem: Problem, frame: Frame, o: Oscillator, t: float) -> bool:
    """Return whether the slip continues past its zero after `t`, where friction cannot hold.

    It then passes close to zero, and turns.
    """
    if not swings(o, t):
        return False
    u_x, u_y = elongation(problem, frame, t, after(o, t)[2], 0.0)
    return margin(problem, frame.t + t, u_x, u_y)[0] > 0.0


@inlined
def predict(
    frame: Frame, start: Outset, o: Oscillator, s: Swing, h: float, memory: Memory
) -> tuple[Triple, Triple]:
    """Return a first guess of the stages (p, w)."""
    if swings(o, h):
        return predict_by_oscillation(frame, start, o, s, h)
    if memory.warm:
        x = h / memory.h_last
        c = (1.0 + C[0] * x, 1.0 + C[1] * x, 1.0 + C[2] * x)
        p = (cubic(memory.p, c[0]), cubic(memory.p, c[1]), cubic(memory.p, c[2]))
        w, turn = memory.w, memory.w[3]
        return p, (cubic(w, c[0]) - turn, cubic(w, c[1]) - turn, cubic(w, c[2]) - turn)
    r = frame.r
    c = (C[0] * h, C[1] * h, C[2] * h)
    change = start.a_1 - start.f
    if r == 0.0:  # take-off (M19): |s| grows with t, or t^2, and turns with the force that held
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
        max(r + change * c[2], REMAINS * r),
    )
    return p, (0.0, 0.0, 0.0)


@inlined
def predict_by_oscillation(
    frame: Frame, start: Outset, o: Oscillator, s: Swing, h: float
) -> tuple[Triple, Triple]:
    """Return a first guess of the stages from the oscillation along the slip.

    The turn w follows from its own equation, linear for given p; its effect on p is added.
    """
    p, k_12, k_22 = s.p, frame.k_12, frame.k_22
    slid, pull = times(A, p), start.a_2 - start.turn
    m = (
        turn_row(start, s, FIRST, h, p, k_22),
        turn_row(start, s, SECOND, h, p, k_22),
        turn_row(start, s, THIRD, h, p, k_22),
    )
    right = (
        h * (pull + h * (C[0] * start.da_2 - k_12 * (slid[0] + s.slid[0]))),
        h * (pull + h * (C[1] * start.da_2 - k_12 * (slid[1] + s.slid[1]))),
        h * (pull + h * (C[2] * start.da_2 - k_12 * (slid[2] + s.slid[2]))),
    )
    w = times(inverse(m), right)
    across = times(A, products(p, w))
    x, f, known = h * k_12, 0.5 * start.f, 0.5 * o.k * o.drift * h * h
    push = (
        f * w[0] * w[0] - x * across[0] - known * C[0] * C[0],
        f * w[1] * w[1] - x * across[1] - known * C[1] * C[1],
        f * w[2] * w[2] - x * across[2] - known * C[2] * C[2],
    )
    more = times(A, push)
    return (p[0] + h * more[0], p[1] + h * more[1], p[2] + h * more[2]), w


@inlined
def turn_row(start: Outset, s: Swing, i: int, h: float, p: Triple, k_22: float) -> Triple:
    """Return the row of stage i in the equations of the turn."""
    x = h * h * k_22
    row = (
        p[i] * D[i][0] + x * A[i][0] * p[0],
        p[i] * D[i][1] + x * A[i][1] * p[1],
        p[i] * D[i][2] + x * A[i][2] * p[2],
    )
    return add_to_entry(row, i, h * start.f + s.dp[i])
