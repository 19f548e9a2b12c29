"""The common mean of values with errors, and whether they differ by more than chance."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np
from scipy.special import chdtrc

from stiction.arrays import Floats

LEAST_ERROR = 1e-6  # of the largest error: a value without noise has not all the weight
DIFFERENT = 1e-3  # probability of values that differ as much by chance


class CommonMean(NamedTuple):
    """The mean of values, weighted by their errors."""

    # the mean, and its standard error by the errors of the values
    value: float
    error: float
    square: float  # chi^2: the sum of squares of the deviations from it over the errors
    weights: Floats  # (n,), squares of the errors' reciprocals

    @property
    def free(self) -> int:
        """Degrees of freedom of chi^2."""
        return len(self.weights) - 1

    @property
    def alike(self) -> bool:
        """Whether the values differ by no more than chance."""
        return self.free == 0 or bool(chdtrc(self.free, self.square) > DIFFERENT)

    @property
    def scaled_error(self) -> float:
        """The error; of values that are not alike that by their scatter."""
        return self.error if self.alike else self.safe_error

    @property
    def safe_error(self) -> float:
        """The error, or that by the scatter of the values if this is larger.

        It is scaled by Birge's ratio (R. T. Birge, Phys. Rev. 40, 207 (1932)). What contradicts the
        user rests on it: errors of the values may be stated too small.
        """
        return self.error * sqrt(max(self.square / max(self.free, 1), 1.0))

    @property
    def variance_between(self) -> float:
        """How far values vary beyond their errors: the variance of single ones, or less than 0.

        By R. DerSimonian & N. Laird, Control. Clin. Trials 7, 177 (1986); 0 if one value has all
        the weight.
        """
        total = float(self.weights.sum())
        others = total - float(self.weights @ self.weights) / total
        return (self.square - self.free) / others if others > 0.0 else 0.0


def common_mean(
    values: Floats, errors: Floats, shares: Floats | None = None, *, times: int = 1
) -> CommonMean:
    """Return the mean of values with standard errors, (n,) each, by weighted least squares.

    The errors are those that values do not share. Further ones, `shares`, each with its sign, are
    by a quantity that is the same for all: one more unknown, zero within its error. So many `times`
    each error counts in values: it is averaged away by so many fewer of them.
    """
    shares = np.zeros(len(values)) if shares is None else shares
    floor = LEAST_ERROR * (float(errors.max()) or 1.0)
    roots = 1.0 / np.maximum(errors, floor)
    rows = np.vstack([np.stack([roots, roots * shares], axis=1), [0.0, sqrt(times)]])
    wanted = np.append(roots * values, 0.0)
    found = np.linalg.lstsq(rows, wanted)[0]
    square = float(np.sum((wanted - rows @ found) ** 2))
    error = sqrt(times * np.linalg.inv(rows.T @ rows)[0, 0])
    return CommonMean(float(found[0]), error, square, roots**2)
