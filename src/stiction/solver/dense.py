"""Values inside a step of slip: dense output.

The collocation polynomial of a step is less exact inside than at the end, by two orders. So a
value inside is the end of a shorter step from the same start, for which that polynomial is a first
guess: mostly one iteration is left, and a run that ends there would give the same.
"""

from __future__ import annotations

from stiction.solver.blocks import Triple, dot, less
from stiction.solver.compiled import inlined
from stiction.solver.frame import Frame, Outset
from stiction.solver.newton import products, solve
from stiction.solver.problem import Problem
from stiction.solver.radau import A, C, cubic, integral
from stiction.solver.state import Accuracy
from stiction.solver.swing import Swing, after, oscillator, swing, swings


@inlined
def within(
    problem: Problem,
    frame: Frame,
    start: Outset,
    laid: Swing,
    h: float,
    p: Triple,
    w: Triple,
    dt: float,
    accuracy: Accuracy,
    motion: float,
) -> tuple[float, float, float, float]:
    """Return the distance slipped after `dt` along and across the step, p and w there."""
    if dt <= 0.0:
        return 0.0, 0.0, frame.r, 0.0
    o, x = oscillator(frame, start), dt / h
    s = swing(o, dt, False)
    if dt == h:
        return ended(h, s, p, w)
    rest, way = less(p, laid.p), (0.0, w[0], w[1], w[2])
    if swings(o, dt) and swings(o, h):
        q = (
            s.p[0] + on_cubic(0.0, rest, C[0] * x),
            s.p[1] + on_cubic(0.0, rest, C[1] * x),
            s.p[2] + on_cubic(0.0, rest, x),
        )
    elif swings(o, h):
        q = (
            after(o, C[0] * dt)[0] + on_cubic(0.0, rest, C[0] * x),
            after(o, C[1] * dt)[0] + on_cubic(0.0, rest, C[1] * x),
            after(o, dt)[0] + on_cubic(0.0, rest, x),
        )
    else:
        q = (
            on_cubic(frame.r, rest, C[0] * x),
            on_cubic(frame.r, rest, C[1] * x),
            on_cubic(frame.r, rest, x),
        )
    turn = cubic(way, C[0] * x), cubic(way, C[1] * x), cubic(way, x)
    first = q[2], turn[2]
    found, s, q, turn, _, _ = solve(problem, frame, o, s, dt, False, q, turn, accuracy, motion)
    if found and min(q) >= 0.0:
        return ended(dt, s, q, turn)
    slid = after(o, dt)[2] if swings(o, h) else 0.0
    return (
        slid + h * integral(rest, x),
        h * integral(products(p, w), x),
        max(first[0], 0.0),
        first[1],
    )


@inlined
def ended(h: float, s: Swing, p: Triple, w: Triple) -> tuple[float, float, float, float]:
    """Return the distance slipped in a step along and across it, p and w at its end."""
    return h * (dot(A[2], p) + s.slid[2]), h * dot(A[2], products(p, w)), p[2], w[2]


@inlined
def on_cubic(first: float, values: Triple, x: float) -> float:
    """Return the cubic through a value at the start and those at the stages."""
    return cubic((first, values[0], values[1], values[2]), x)
