"""Polynomials fitted to many pieces of a series at once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.arrays import Floats, Indices


class Fits(NamedTuple):
    """Polynomials c_0 + c_1 x + ... in x = (t - middle)/half, which is -1 to 1 over each piece.

    Parameters
    ----------
    coefficients : ndarray
        (pieces, degree + 1), in the unit of the values.
    middle, half : ndarray
        (pieces,), in the unit of the time.
    """

    coefficients: Floats
    middle: Floats
    half: Floats

    def at(self, x: Floats) -> Floats:
        """Return each polynomial's value at its x."""
        powers = x[:, None] ** np.arange(self.coefficients.shape[1])
        values: Floats = (self.coefficients * powers).sum(axis=1)
        return values


def fit_pieces(time: Floats, values: Floats, first: Indices, last: Indices, degree: int) -> Fits:
    """Fit by least squares to the samples `first` to `last` (included) of each piece.

    Each piece has more samples than the degree; pieces may overlap.
    """
    counts = last - first + 1
    begins = np.cumsum(counts) - counts
    piece = np.repeat(np.arange(len(first)), counts)
    at = np.arange(len(piece)) - begins[piece] + first[piece]
    middle, half = 0.5 * (time[last] + time[first]), 0.5 * (time[last] - time[first])
    x = (time[at] - middle[piece]) / half[piece]
    y = values[at]
    moments = [np.add.reduceat(x**power, begins) for power in range(2 * degree + 1)]
    sums = [np.add.reduceat(y * x**power, begins) for power in range(degree + 1)]
    rows = np.arange(degree + 1)
    normal = np.stack(moments, axis=1)[:, rows[:, None] + rows]
    right = np.stack(sums, axis=1)[:, :, None]
    return Fits(np.linalg.solve(normal, right)[:, :, 0], middle, half)
