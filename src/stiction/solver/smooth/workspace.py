"""The arrays in which a step is computed, allocated once for each call of the loop.

Rows are points in time: the step's start, its three stages, a point inside it, and one for
trials. Columns are slip x, y and the internal states z. These arrays hold what depends on
the number of states; slip and friction of a step are plain numbers.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.solver.compilation.jit import number, switch

ROWS = 6
START, FIRST, SECOND, LAST, INSIDE, TRIAL = map(number, range(ROWS))  # rows
X, Y = number(0), number(1)  # columns
WANTED, UNWANTED = switch(True), switch(False)  # derivatives


class Workspace(NamedTuple):
    """Arrays over rows and columns.

    values : slip velocity (m/s) and z; changes : friction over mass (only where it is
    needed) and dz/dt; jacobian : derivatives of the changes by values, ``[row, of, by]``; size :
    scales of the errors of values; error : estimated error of values inside the step; past : slip
    coordinate and z of the last step; cubic : values inside the step and their derivative
    times h, ``[which, column]``; blocks, point, right : linear equations of a step and of a
    point inside it, see `elimination`; rates, growth : matrix of a small disturbance of
    (u, s, z), and three for what becomes of it, see `stepping.amplification`.
    """

    values: np.ndarray
    changes: np.ndarray
    jacobian: np.ndarray
    size: np.ndarray
    error: np.ndarray
    past: np.ndarray
    cubic: np.ndarray
    blocks: np.ndarray
    point: np.ndarray
    right: np.ndarray
    rates: np.ndarray
    growth: np.ndarray


def workspace(n: int) -> Workspace:
    """Return the arrays for `n` internal states."""
    n += 2
    return Workspace(
        np.zeros((ROWS, n)),
        np.zeros((ROWS, n)),
        np.zeros((ROWS, n, n)),
        np.ones(n),
        np.zeros(n),
        np.zeros((4, n)),
        np.zeros((2, n)),
        np.zeros((n, n, 9)),
        np.zeros((n, n)),
        np.zeros((n, 3)),
        np.zeros((2 + n, 2 + n)),
        np.zeros((3, 2 + n, 2 + n)),
    )
