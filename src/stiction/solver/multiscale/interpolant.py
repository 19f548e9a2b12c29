"""Patches of the return map: polynomials that represent many cycles, and steps along them.

The nodes are Leja points, the polynomials Newton's: each new node is a fresh cycle that tests the
present polynomial about where it is worst, and then improves it.

The third polynomial is the square of the time held. At an edge of the map, the stick at the end of
a cycle shrinks to zero in a grazing: its length goes with the square root of the distance to the
edge (M55), whereas turn and time have a finite slope and then a term of the power 3/2. The square
of the length is as smooth as they are.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from stiction.solver.compilation.jit import inlined
from stiction.solver.multiscale.return_map import (
    NODES,
    PATCH_NODES,
    PATCH_SCALE,
    PATCH_START,
    PATCHES_MADE,
    Cycle,
    Returns,
)


def leja(count: int) -> np.ndarray:
    """Return Leja points on [-1, 1]: each maximises the product of distances to earlier ones."""
    grid = np.cos(np.linspace(np.pi, 0.0, 2001))
    points = [-1.0, 1.0]
    while len(points) < count:
        distances = np.prod([np.abs(grid - point) for point in points], axis=0)
        points.append(float(grid[distances.argmax()]))
    return np.array(points)


POINTS = leja(NODES)


@inlined
def interpolate(coefficients: np.ndarray, n: int, x: float) -> tuple[float, float, float]:
    """Return the polynomials through the first `n` nodes: turn, time (s), time held squared.

    It sums two halves in parallel, for speed; for odd `n` the row after the last coefficients is
    read too, and must be zero.
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
def locate(known: Returns, theta: float) -> tuple[int, float]:
    """Return the row of the patch that contains an angle, or -1, and the place in it, -1 to 1."""
    for row in range(known.sizes[PATCHES_MADE]):
        x = (theta - known.patches[row, PATCH_START]) * known.patches[row, PATCH_SCALE] - 1.0
        if -1.0 <= x <= 1.0:
            return row, x
    return -1, 0.0


@inlined
def cycle_from(known: Returns, row: int, x: float) -> Cycle:
    """Return the cycle from a place in a patch; its time held is zero without a stick."""
    n = int(known.patches[row, PATCH_NODES])
    turn, time, square = interpolate(known.coefficients[row], n, x)
    return Cycle(turn, time, sqrt(max(square, 0.0)))
