"""Patches of the return map: polynomials that stand for many cycles, and the way along them.

Nodes are Leja points and polynomials Newton's: each further node is at the same time a fresh
cycle, which tests the polynomial so far, about where it is worst; and none is in vain.

The third polynomial is the square of the time held. Where the map has an edge the stick that
ends a cycle shrinks to nothing, as a grazing does: its length like a square root of the distance
to the edge (M55), while turn and time have a slope there and then a term of the power 3/2. Its
square is as smooth as they are.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from stiction.solver.compilation.jit import inlined, piece
from stiction.solver.multiscale.return_map import NODES, Cycle, Hold, Returns
from stiction.solver.multiscale.section import wrapped


def leja(count: int) -> np.ndarray:
    """Return points on [-1, 1], each where the product of distances to those before is largest."""
    grid = np.cos(np.linspace(np.pi, 0.0, 2001))
    points = [-1.0, 1.0]
    while len(points) < count:
        distances = np.prod([np.abs(grid - point) for point in points], axis=0)
        points.append(float(grid[distances.argmax()]))
    return np.array(points)


POINTS = leja(NODES)


@inlined
def interpolated(coefficients: np.ndarray, n: int, x: float) -> tuple[float, float, float]:
    """Return the polynomials through the first `n` nodes: turn, time (s), time held squared.

    In two halves side by side, since each waits for its own sums; with `n` odd the one after
    the last coefficients is read as well, and must be zero.
    """
    half = (n + 1) // 2
    turn = time = square = turn_above = time_above = square_above = 0.0
    product = 1.0
    for i in range(half - 1, -1, -1):
        j = i + half
        d, e = x - POINTS[i], x - POINTS[j]
        turn = turn * d + coefficients[i, 0]
        time = time * d + coefficients[i, 1]
        square = square * d + coefficients[i, 2]
        turn_above = turn_above * e + coefficients[j, 0]
        time_above = time_above * e + coefficients[j, 1]
        square_above = square_above * e + coefficients[j, 2]
        product *= d
    return (
        turn + product * turn_above,
        time + product * time_above,
        square + product * square_above,
    )


@inlined
def place(known: Returns, theta: float) -> tuple[int, float]:
    """Return the row of a patch with an angle, -1 if there is none, and where in it, -1 to 1."""
    for row in range(known.sizes[0]):
        x = (theta - known.patches[row, 0]) * known.patches[row, 1] - 1.0
        if -1.0 <= x <= 1.0:
            return row, x
    return -1, 0.0


@inlined
def cycle_from(known: Returns, row: int, x: float) -> Cycle:
    """Return the cycle from a place in a patch; it holds for no time where there is no stick."""
    n = int(known.patches[row, 2])
    turn, time, square = interpolated(known.coefficients[row], n, x)
    return Cycle(turn, time, sqrt(max(square, 0.0)))


@piece
def followed(
    known: Returns, hold: Hold, cycle: Cycle, sticks: np.ndarray, count: int, until: float
) -> tuple[Hold, Cycle, int, float]:
    """Follow the patches from a stick on: past their ends, `until` (s), or out of room.

    By itself, so that the loop has all registers: this is what most of a long run consists of.

    Returns
    -------
    hold, cycle
        The stick arrived at, and the cycle before it.
    count : int
        Of sticks so far, those passed by written to `sticks`.
    stuck : float
        Their sum, s.
    """
    (start, end, theta), stuck = hold, 0.0
    row, x = place(known, theta)
    while row >= 0 and count < len(sticks):
        following = cycle_from(known, row, x)
        turn, time, held = following
        if not (0.0 < held < time and end + time < until):
            break
        sticks[count, 0] = start
        sticks[count, 1] = end
        stuck += end - start
        count += 1
        start, end, theta = end + (time - held), end + time, wrapped(theta + turn)
        cycle = following
        x = (theta - known.patches[row, 0]) * known.patches[row, 1] - 1.0
        if not -1.0 <= x <= 1.0:
            row, x = place(known, theta)
    return Hold(start, end, theta), cycle, count, stuck
