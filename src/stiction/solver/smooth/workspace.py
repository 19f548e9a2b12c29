"""The room in which a step is computed, made once for each call of the loop.

Rows are points in time: the step's start, its three stages, a point inside it, and one for
trials. Columns are slip x, y and the internal states z.
"""

from __future__ import annotations

from typing import NamedTuple, cast

import numpy as np

from stiction.solver.compilation.jit import allocating

ROWS = 6
# stages: 1, 2, 3; numbers of numpy, or numba would compile for each of them anew
START, INSIDE, TRIAL = (cast(int, np.int64(row)) for row in (0, 4, 5))


class Workspace(NamedTuple):
    """Arrays over rows and columns.

    y : unknowns, slip coordinate q and z; values : slip velocity (m/s) and z; flow : friction
    over mass and dz/dt; jacobian : their derivatives by y, ``[row, of, by]``; pull : what acts on
    the mass beside friction and what slip changes (m/s^2); weight : normal load (N); share : of
    inertia in what resists a change of q; size : what z is held against; cubic : coefficients of
    values inside the step, ``[power, column]``; error : its estimated error; past : values of
    the last step; matrix, right, order, scale : linear equations.
    """

    y: np.ndarray
    values: np.ndarray
    flow: np.ndarray
    jacobian: np.ndarray
    pull: np.ndarray
    weight: np.ndarray
    share: np.ndarray
    size: np.ndarray
    cubic: np.ndarray
    error: np.ndarray
    past: np.ndarray
    matrix: np.ndarray
    right: np.ndarray
    order: np.ndarray
    scale: np.ndarray


@allocating
def workspace(n: int) -> Workspace:
    """Return the arrays for `n` internal states."""
    n += 2
    return Workspace(
        np.zeros((ROWS, n)),
        np.zeros((ROWS, n)),
        np.zeros((ROWS, n)),
        np.zeros((ROWS, n, n)),
        np.zeros((ROWS, 2)),
        np.zeros(ROWS),
        np.zeros(ROWS),
        np.ones(n),
        np.zeros((4, n)),
        np.zeros(n),
        np.zeros((4, n)),
        np.zeros((3 * n, 3 * n)),
        np.zeros(3 * n),
        np.zeros(3 * n, np.int64),
        np.zeros(3 * n),
    )
