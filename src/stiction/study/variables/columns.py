"""Columns of a run from the solver's own samples, in one pass of compiled code."""

from __future__ import annotations

import numpy as np

from stiction.solver.compilation.jit import compiled_with_arrays


@compiled_with_arrays
def even_columns(
    samples: np.ndarray,
    fine: int,
    parts: int,
    drive: np.ndarray,
    way: float,
    k_x: float,
    c: float,
    s: float,
) -> np.ndarray:
    """Return force and its rate, velocity, slip speed and elongation along X, (5, n).

    Of the solver's samples, of which those from `fine` on are closer by a factor of `parts`; X is
    along (c, s), and (m,) `drive` is its velocity, one value if constant.
    """
    n = fine + (len(samples) - fine + parts - 1) // parts
    columns = np.empty((5, n))
    for i in range(n):
        row = samples[i if i < fine else fine + (i - fine) * parts]
        u_x, u_y, slip_x, slip_y = row[0], row[1], row[2], row[3]
        columns[0, i] = way * k_x * u_x
        columns[1, i] = way * k_x * (c * drive[min(i, len(drive) - 1)] - slip_x)
        columns[2, i] = way * (c * slip_x + s * slip_y)
        columns[3, i] = np.sqrt(slip_x * slip_x + slip_y * slip_y)
        columns[4, i] = c * u_x + s * u_y
    return columns
