"""Linear equations of any size, in arrays that are there already."""

from __future__ import annotations

import numpy as np

from stiction.solver.compilation.jit import piece


@piece
def factorise(m: np.ndarray, order: np.ndarray, scale: np.ndarray, n: int) -> bool:
    """Factorise the first `n` rows and columns in place; return whether that was possible.

    Elimination with pivots from scaled rows: the rows may be in different units.
    """
    for i in range(n):
        largest = 0.0
        for j in range(n):
            largest = max(largest, abs(m[i, j]))
        if not 0.0 < largest < np.inf:
            return False
        scale[i] = 1.0 / largest
    for k in range(n):
        pivot, largest = k, abs(m[k, k]) * scale[k]
        for i in range(k + 1, n):
            size = abs(m[i, k]) * scale[i]
            if size > largest:
                pivot, largest = i, size
        if not largest > 0.0:
            return False
        order[k] = pivot
        if pivot != k:
            scale[pivot] = scale[k]
            for j in range(n):
                m[k, j], m[pivot, j] = m[pivot, j], m[k, j]
        per_pivot = 1.0 / m[k, k]
        for i in range(k + 1, n):
            if m[i, k] != 0.0:
                f = m[i, k] * per_pivot
                m[i, k] = f
                for j in range(k + 1, n):
                    m[i, j] -= f * m[k, j]
    return True


@piece
def solve_in_place(m: np.ndarray, order: np.ndarray, x: np.ndarray, n: int) -> None:
    """Replace the right-hand side `x` by the solution, with what `factorise` made of `m`."""
    for k in range(n):
        pivot = order[k]
        if pivot != k:
            x[k], x[pivot] = x[pivot], x[k]
    for i in range(n):
        value = x[i]
        for j in range(i):
            value -= m[i, j] * x[j]
        x[i] = value
    for i in range(n - 1, -1, -1):
        value = x[i]
        for j in range(i + 1, n):
            value -= m[i, j] * x[j]
        x[i] = value / m[i, i]
