"""A learned summary: what features say about each parameter, by kernel ridge regression.

The summary of a record is the regression's estimate of the posterior mean, which loses little of
what the features say (P. Fearnhead & D. Prangle, J. R. Stat. Soc. B 74, 419 (2012)). That of each
record in the library comes from a regression without this record, so that a new record is on the
same footing as those of the library.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

Floats = NDArray[np.float64]

WIDTHS = (1.0, 3.0)  # of the kernel, over the typical distance between records
RIDGES = 10.0 ** np.arange(-6.0, 2.1, 0.5)
STRAIGHT = 1.0  # share of the linear kernel beside the curved one
LEAST = 1e-8  # squared distance, in place of zero
LEAST_CHANGE = 1e-9  # standard deviation of a feature that counts as constant
FARTHEST = 5.0  # standard deviations from the library's mean, to which features are clipped


class Standard(NamedTuple):
    """Middle and spread of each feature in the library."""

    mean: Floats
    spread: Floats

    @classmethod
    def of(cls, features: Floats) -> Self:
        """Return those of a library's features, (n, f)."""
        spread = features.std(axis=0)
        return cls(features.mean(axis=0), np.where(spread > LEAST_CHANGE, spread, np.inf))

    def scores(self, features: Floats) -> Floats:
        """Return features in standard deviations from the middle, clipped."""
        found: Floats = np.clip((features - self.mean) / self.spread, -FARTHEST, FARTHEST)
        return found


class Regression(NamedTuple):
    """A kernel ridge regression of targets (n, p) over standardised features.

    Parameters
    ----------
    width : ndarray
        (p,), of the kernel for each target.
    weights : ndarray
        (n, p).
    mean : ndarray
        (p,), of the targets.
    library : ndarray
        (n, p), the prediction for each record of the library, from all others.
    """

    width: Floats
    weights: Floats
    mean: Floats
    library: Floats

    def predict(self, new: Floats, scores: Floats) -> Floats:
        """Return predictions for new scores (m, f), given those of the library."""
        found = np.empty((len(new), self.weights.shape[1]))
        for width in np.unique(self.width):
            which = self.width == width
            found[:, which] = kernel(new, scores, width) @ self.weights[:, which]
        return found + self.mean


class Summary(NamedTuple):
    """What features say about parameters: where they lie, and how far they scatter about that.

    Parameters
    ----------
    standard : Standard
        How features are made comparable.
    scores : ndarray
        (n, f), standardised features of the library.
    middle : Regression
        Of the parameters.
    spread : Regression
        Of the logarithm of their squared distance from it.
    """

    standard: Standard
    scores: Floats
    middle: Regression
    spread: Regression

    def __call__(self, features: Floats) -> tuple[Floats, Floats]:
        """Return middles and spreads (m, p) for records with these features (m, f)."""
        new = self.standard.scores(np.atleast_2d(features))
        spread = np.exp(0.5 * self.spread.predict(new, self.scores))
        return self.middle.predict(new, self.scores), spread

    @property
    def library(self) -> tuple[Floats, Floats]:
        """Middles and spreads (n, p) of the library's own records, each from all others."""
        return self.middle.library, np.exp(0.5 * self.spread.library)


def learn(features: Floats, parameters: Floats) -> Summary:
    """Learn the summary of a library: features (n, f) and parameters (n, p)."""
    standard = Standard.of(features)
    scores = standard.scores(features)
    parts = [(width, *decompose(kernel(scores, scores, width))) for width in WIDTHS]
    middle = regression(parts, parameters)
    apart = parameters - middle.library
    return Summary(standard, scores, middle, regression(parts, np.log(apart * apart + LEAST)))


def regression(parts: Sequence[tuple[float, Floats, Floats]], targets: Floats) -> Regression:
    """Return the regression with the widths and ridges that predict left-out records best."""
    mean = targets.mean(axis=0)
    centred = targets - mean
    best = np.full(targets.shape[1], np.inf)
    width, weights, library = np.empty(len(best)), np.empty_like(targets), np.empty_like(targets)
    for trial, values, vectors in parts:
        for tried, left_out in ridges(values, vectors, centred):
            error = ((left_out - centred) ** 2).mean(axis=0)
            better = error < best
            best[better], width[better] = error[better], trial
            weights[:, better], library[:, better] = tried[:, better], left_out[:, better]
    return Regression(width, weights, mean, library + mean)


def kernel(a: Floats, b: Floats, width: float) -> Floats:
    """Return the covariance of two sets of records: a linear and a Gaussian kernel.

    Distances are relative to the square root of the number of features.
    """
    count = a.shape[1]
    inner = a @ b.T / count
    square = (a * a).mean(axis=1)[:, None] + (b * b).mean(axis=1)[None, :] - 2.0 * inner
    found: Floats = STRAIGHT * inner + np.exp(-0.5 * np.maximum(square, 0.0) / width**2)
    return found


def decompose(matrix: Floats) -> tuple[Floats, Floats]:
    """Return eigenvalues, none below zero, and eigenvectors."""
    values, vectors = eigh(matrix, driver="evd", check_finite=False, overwrite_a=True)
    return np.maximum(values, 0.0), vectors


def ridges(values: Floats, vectors: Floats, targets: Floats) -> Iterator[tuple[Floats, Floats]]:
    """Yield, for each ridge, the weights and the predictions for each record from all others.

    The latter in closed form (G. H. Golub, M. Heath & G. Wahba, Technometrics 21, 215 (1979)).
    """
    turned = vectors.T @ targets
    squares = vectors * vectors
    for ridge in RIDGES * len(values):
        inverse = 1.0 / (values + ridge)
        weights = vectors @ (inverse[:, None] * turned)
        yield weights, targets - weights / (squares @ inverse)[:, None]
