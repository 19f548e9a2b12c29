"""How far a solution is from the reference."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .problem import K_X, K_Y, PUBLISHED_U_X, PUBLISHED_U_Y


class Accuracy(NamedTuple):
    """Distance from the reference.

    Attributes
    ----------
    spring_x, spring_y : float
        Largest error of ``k_x u_x`` and ``k_y u_y`` on the grid, in N.
    u_x_end : float
        Relative error of ``u_x`` at the end, unsigned.
    """

    spring_x: float
    spring_y: float
    u_x_end: float


def accuracy(force: NDArray[np.float64], reference: NDArray[np.float64]) -> Accuracy:
    """Compare two spring forces on the grid, in N, shape (n, 2)."""
    largest = np.abs(force - reference).max(axis=0)
    end = abs(force[-1, 0] / reference[-1, 0] - 1.0)
    return Accuracy(float(largest[0]), float(largest[1]), float(end))


def as_accurate(one: Accuracy, other: Accuracy) -> bool:
    """Whether no error of `one` is larger than that of `other`, the single instant left aside."""
    return one.spring_x <= other.spring_x and one.spring_y <= other.spring_y


def beside_published(reference: NDArray[np.float64]) -> tuple[float, float]:
    """Return the signed relative deviations of u_x and u_y at 5 s from the published values."""
    u_x, u_y = reference[-1] / np.array([K_X, K_Y])
    return float(u_x / PUBLISHED_U_X - 1.0), float(u_y / PUBLISHED_U_Y - 1.0)
