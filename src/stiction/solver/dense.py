"""Values inside a step of slip.

Where a step resolves the springs' own motion, distances are the quintic through their values
and first two derivatives at both ends, accurate to h^6 like the step itself. In a longer step
they are the collocation polynomial's: its forces balance, as the error estimate has seen; an error
of the slip that the tolerance allows would be, over so long a time, much to a stiff spring.
"""

from __future__ import annotations

from typing import NamedTuple

from stiction.solver.blocks import Triple, dot, less
from stiction.solver.compiled import inlined
from stiction.solver.frame import Frame, Outset
from stiction.solver.newton import products
from stiction.solver.problem import Problem
from stiction.solver.radau import A, cubic, integral
from stiction.solver.slip import stage
from stiction.solver.swing import MOST, Oscillator, Swing, after, oscillator, swings


class End(NamedTuple):
    """Slip speed (m/s), its rate of change (m/s^2) and the distance slipped (m), at one place."""

    v: float
    a: float
    slid: float


class Ends(NamedTuple):
    """Both ends of a step, along and across it, less what it is laid over."""

    oscillator: Oscillator
    laid: bool
    first_1: End
    last_1: End
    first_2: End
    last_2: End


@inlined
def ends_of(
    problem: Problem, frame: Frame, start: Outset, swing: Swing, h: float, p: Triple, w: Triple
) -> Ends:
    """Return both ends of a step."""
    q = products(p, w)
    end = stage(problem, frame, swing, h, 2, p, w, q)
    n, o = end.flow, oscillator(frame, start)
    laid = swings(o, h)
    r, v, over = frame.r, start.a_1 - start.f, End(0.0, 0.0, 0.0)
    if laid:
        r, v, over = 0.0, 0.0, End(*after(o, h))
    slid = h * (dot(A[2], p) + swing.slid[2])
    return Ends(
        o,
        laid,
        End(r, v, 0.0),
        End(p[2] - over.v, end.a_1 - end.f * n.n_1 - over.a, slid - over.slid),
        End(0.0, start.a_2 - start.turn, 0.0),
        End(q[2], end.a_2 - end.f * (n.tau + w[2] * n.n_1), h * dot(A[2], q)),
    )


@inlined
def within(
    frame: Frame, swing: Swing, ends: Ends, h: float, p: Triple, q: Triple, dt: float
) -> tuple[float, float, float, float]:
    """Return the distance slipped after `dt` along and across the step, and the slip velocity."""
    x = dt / h
    if (frame.k_11 + frame.k_22) * h * h > 2.0 * MOST:
        rest = less(p, swing.p)
        z_1, s_1 = h * integral(rest, x), cubic((ends.first_1.v, rest[0], rest[1], rest[2]), x)
        z_2, s_2 = h * integral(q, x), cubic((0.0, q[0], q[1], q[2]), x)
    else:
        z_1, s_1 = quintic(h, x, ends.first_1, ends.last_1)
        z_2, s_2 = quintic(h, x, ends.first_2, ends.last_2)
    if ends.laid:
        v, _, slid = after(ends.oscillator, dt)
        z_1, s_1 = z_1 + slid, s_1 + v
    return z_1, z_2, s_1, s_2


@inlined
def quintic(h: float, x: float, first: End, last: End) -> tuple[float, float]:
    """Return value and derivative at x h of the quintic from 0 with the given ends."""
    b, c = first.v * h, 0.5 * first.a * h * h
    dy, dv, da = last.slid - b - c, last.v * h - b - 2 * c, last.a * h * h - 2 * c
    c3, c4, c5 = 10 * dy - 4 * dv + 0.5 * da, 7 * dv - 15 * dy - da, 6 * dy - 3 * dv + 0.5 * da
    y = x * (b + x * (c + x * (c3 + x * (c4 + x * c5))))
    v = (b + x * (2 * c + x * (3 * c3 + x * (4 * c4 + x * 5 * c5)))) / h
    return y, v
