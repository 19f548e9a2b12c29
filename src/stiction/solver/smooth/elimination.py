"""Elimination of internal states from linear equations, leaving equations for the slip.

The unknowns are slip x and y and the states z, each at three stages, so that the coefficients of
one unknown in one equation are a block of 3 by 3 (M68). The states' own blocks need no pivots:
states that decay add positive numbers to the diagonal of D, and Radau IIA leaves that regular.
"""

from __future__ import annotations

from stiction.solver.compilation.jit import inlined
from stiction.solver.smooth.right_hand_side import Point, Stages
from stiction.solver.smooth.workspace import INSIDE, START, Workspace, X, Y
from stiction.solver.stepping.block_algebra import Matrix, Triple, inverse, less, product, times
from stiction.solver.stepping.radau import D

Blocks = tuple[Matrix, Matrix, Matrix, Matrix]
# coefficients of two equations (xx, xy, yx, yy) and their residuals
Equations = tuple[float, float, float, float, float, float]


@inlined
def block(w: Workspace, i: int, j: int) -> Matrix:
    """Return one block of the equations."""
    m = w.blocks[i, j]
    return (m[0], m[1], m[2]), (m[3], m[4], m[5]), (m[6], m[7], m[8])


@inlined
def put(w: Workspace, i: int, j: int, m: Matrix) -> None:
    """Write a block of the equations."""
    to = w.blocks[i, j]
    to[0], to[1], to[2] = m[0]
    to[3], to[4], to[5] = m[1]
    to[6], to[7], to[8] = m[2]


@inlined
def put_diagonal(w: Workspace, i: int, j: int, d: Triple) -> None:
    """Write a block that couples each stage with itself only."""
    put(w, i, j, ((d[0], 0.0, 0.0), (0.0, d[1], 0.0), (0.0, 0.0, d[2])))


@inlined
def without_states(h: float, stages: Stages, slip: Blocks, w: Workspace) -> Blocks:
    """Return the blocks of slip x and y (xx, xy, yx, yy) after eliminating the states."""
    n, jacobian = w.size.shape[0], w.jacobian
    put(w, X, X, slip[0])
    put(w, X, Y, slip[1])
    put(w, Y, X, slip[2])
    put(w, Y, Y, slip[3])
    xx, xy, yy = stages.s_xx, stages.s_xy, stages.s_yy
    for k in range(2, n):
        x1, x2, x3 = jacobian[1, k, 0], jacobian[2, k, 0], jacobian[3, k, 0]
        y1, y2, y3 = jacobian[1, k, 1], jacobian[2, k, 1], jacobian[3, k, 1]
        by_x = x1 * xx[0] + y1 * xy[0], x2 * xx[1] + y2 * xy[1], x3 * xx[2] + y3 * xy[2]
        by_y = x1 * xy[0] + y1 * yy[0], x2 * xy[1] + y2 * yy[1], x3 * xy[2] + y3 * yy[2]
        put_diagonal(w, k, X, (-h * by_x[0], -h * by_x[1], -h * by_x[2]))
        put_diagonal(w, k, Y, (-h * by_y[0], -h * by_y[1], -h * by_y[2]))
        for a in range(n):
            sign = h if a < 2 else -h
            own = sign * jacobian[1, a, k], sign * jacobian[2, a, k], sign * jacobian[3, a, k]
            put_diagonal(w, a, k, own)
        put(w, k, k, with_diagonal(D, (w.blocks[k, k, 0], w.blocks[k, k, 4], w.blocks[k, k, 8])))
    for k in range(n - 1, 1, -1):
        inverted = inverse(block(w, k, k))
        put(w, k, k, inverted)
        for b in range(k):
            put(w, k, b, product(inverted, block(w, k, b)))
        for a in range(k):
            by_state = block(w, a, k)
            for b in range(k):
                put(w, a, b, difference(block(w, a, b), product(by_state, block(w, k, b))))
    return block(w, X, X), block(w, X, Y), block(w, Y, X), block(w, Y, Y)


@inlined
def with_diagonal(m: Matrix, d: Triple) -> Matrix:
    """Return a matrix with `d` added to its diagonal."""
    a, b, c = m
    return (a[0] + d[0], a[1], a[2]), (b[0], b[1] + d[1], b[2]), (c[0], c[1], c[2] + d[2])


@inlined
def difference(a: Matrix, b: Matrix) -> Matrix:
    """Return a - b."""
    return less(a[0], b[0]), less(a[1], b[1]), less(a[2], b[2])


@inlined
def entry(w: Workspace, k: int) -> Triple:
    """Return a triple of the right-hand side."""
    right = w.right[k]
    return right[0], right[1], right[2]


@inlined
def enter(w: Workspace, k: int, x: Triple) -> None:
    """Write a triple of the right-hand side."""
    right = w.right[k]
    right[0], right[1], right[2] = x


@inlined
def residuals_without(h: float, x: Triple, y: Triple, w: Workspace) -> tuple[Triple, Triple]:
    """Return the slip's residuals x and y after eliminating the states' residuals (M67)."""
    enter(w, X, x)
    enter(w, Y, y)
    for k in range(w.size.shape[0] - 1, 1, -1):
        v = w.values
        z = v[1, k] - v[START, k], v[2, k] - v[START, k], v[3, k] - v[START, k]
        change = h * w.changes[1, k], h * w.changes[2, k], h * w.changes[3, k]
        enter(w, k, less(times(D, z), change))
    for k in range(w.size.shape[0] - 1, 1, -1):
        found = times(block(w, k, k), entry(w, k))
        enter(w, k, found)
        for a in range(k):
            enter(w, a, less(entry(w, a), times(block(w, a, k), found)))
    return entry(w, X), entry(w, Y)


@inlined
def correct_states(x: Triple, y: Triple, w: Workspace) -> float:
    """Correct the states at the stages for a correction of slip; return the largest change.

    It is relative to the states' sizes.
    """
    enter(w, X, x)
    enter(w, Y, y)
    size = 0.0
    for k in range(2, w.size.shape[0]):
        found = entry(w, k)
        for b in range(k):
            found = less(found, times(block(w, k, b), entry(w, b)))
        enter(w, k, found)
        for i in range(3):
            w.values[i + 1, k] -= found[i]
            part = abs(found[i]) / w.size[k]
            size = part if not part <= size else size
    return size


@inlined
def slip_without_states(
    g: float, weight: float, at: Point, slip: Equations, w: Workspace
) -> Equations:
    """Return the equations (M70) of slip inside a step after eliminating the states.

    `g` is the weight times the step size.
    """
    n, i, m, r = w.size.shape[0], INSIDE, w.point, w.right
    m[0, 0], m[0, 1], m[1, 0], m[1, 1], r[0, 0], r[1, 0] = slip
    for k in range(2, n):
        x, y = w.jacobian[i, k, 0], w.jacobian[i, k, 1]
        m[k, 0] = -g * (x * at.s_xx + y * at.s_xy)
        m[k, 1] = -g * (x * at.s_xy + y * at.s_yy)
        for a in range(n):
            m[a, k] = g * w.jacobian[i, a, k] if a < 2 else -g * w.jacobian[i, a, k]
        m[k, k] += 1.0
        r[k, 0] = w.values[i, k] - w.cubic[0, k] + weight * w.cubic[1, k] - g * w.changes[i, k]
    for k in range(n - 1, 1, -1):
        per = 1.0 / m[k, k]
        r[k, 0] *= per
        for b in range(k):
            m[k, b] *= per
        for a in range(k):
            r[a, 0] -= m[a, k] * r[k, 0]
            for b in range(k):
                m[a, b] -= m[a, k] * m[k, b]
    return m[0, 0], m[0, 1], m[1, 0], m[1, 1], r[0, 0], r[1, 0]


@inlined
def correct_states_inside(x: float, y: float, w: Workspace) -> float:
    """Correct the states inside a step, as `correct_states` does at the stages."""
    r, size = w.right, 0.0
    r[0, 0], r[1, 0] = x, y
    for k in range(2, w.size.shape[0]):
        for b in range(k):
            r[k, 0] -= w.point[k, b] * r[b, 0]
        w.values[INSIDE, k] -= r[k, 0]
        part = abs(r[k, 0]) / w.size[k]
        size = part if not part <= size else size
    return size
