"""A learned summary: estimates of each parameter from features, by kernel ridge regression.

The summary of a record is the regression's estimate of the posterior mean, which loses little of
what the features say (P. Fearnhead & D. Prangle, J. R. Stat. Soc. B 74, 419 (2012)). That of each
record in the library comes from a regression without this record, so that a new record is on the
same footing as those of the library.

Each parameter depends on a few combinations of features only. The kernel's metric of each follows
from a first regression with the same metric for all: the average outer product of its gradient
(A. Radhakrishnan, D. Beaglehole, P. Pandit & M. Belkin, Science 383, 1461 (2024)).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from typing import NamedTuple, Self

import numpy as np
from scipy.linalg import eigh
from scipy.linalg.lapack import dpotrf, dpotrs, dtrtri  # type: ignore[attr-defined]
from threadpoolctl import threadpool_limits

from stiction.arrays import Floats
from stiction.progress.report import Progress, part, silent

WIDTHS = (1.0, 3.0)  # of the kernel, over the typical distance between records
FINER = 0.3  # ridge with the metric of a parameter, over that without
UNKNOWN = 0.8  # error of a target over its variance, above which features say nothing of it
ROUND = 0.05  # share of the first metric that remains
RIDGES = 10.0 ** np.arange(-6.0, 2.1, 0.5)
STRAIGHT = 1.0  # share of the linear kernel beside the curved one
LEAST_SQUARE = 1e-8  # squared distance, in place of zero
LEAST_CHANGE = 1e-9  # standard deviation of a feature that counts as constant
FARTHEST = 5.0  # spreads from the library's middle, to which features are clipped
CENTRAL = (16.0, 50.0, 84.0)  # percentiles: one standard deviation to each side, if normal


class Standard(NamedTuple):
    """Middle and spread of each feature in the library: its median and half of its central 68 %.

    Means and standard deviations follow the few simulations that hardly slip: beside their features
    those of all others are alike, and intervals of the misalignment came out a quarter wider.
    """

    middle: Floats
    spread: Floats

    @classmethod
    def of(cls, features: Floats) -> Self:
        """Return the median and spread of each feature of a library, (n, f)."""
        low, middle, high = np.percentile(features, CENTRAL, axis=0)
        deviation = features.std(axis=0)
        spread = np.where(high - low > LEAST_CHANGE, 0.5 * (high - low), deviation)
        return cls(middle, np.where(deviation > LEAST_CHANGE, spread, np.inf))

    def scores(self, features: Floats) -> Floats:
        """Return features as distances from the median in spreads, clipped."""
        found: Floats = np.clip((features - self.middle) / self.spread, -FARTHEST, FARTHEST)
        return found


class Regression(NamedTuple):
    """A kernel ridge regression of targets (n, p) over standardised features."""

    # (p,), of the kernel for each target
    width: Floats
    ridge: Floats
    metric: Floats  # (p, f, f), by which features are multiplied; (1, f, f) where it is that of all
    weights: Floats  # (n, p)
    mean: Floats  # (p,), of the targets
    library: Floats  # (n, p), the prediction for each record of the library, from all others

    def predict(self, new: Floats, scores: Floats) -> Floats:
        """Return predictions for new scores (m, f), given those of the library."""
        found = np.empty((len(new), self.weights.shape[1]))
        metrics = np.minimum(np.arange(found.shape[1]), len(self.metric) - 1)
        for number, width in {*zip(metrics.tolist(), self.width.tolist(), strict=True)}:
            some, metric = (metrics == number) & (self.width == width), self.metric[number]
            found[:, some] = kernel(new @ metric, scores @ metric, width) @ self.weights[:, some]
        return found + self.mean


class FeatureSummary(NamedTuple):
    """Estimates of parameters from features, and the scatter of the estimates."""

    standard: Standard  # how features are made comparable
    scores: Floats  # (n, f), standardised features of the library
    middle: Regression  # of the parameters
    spread: Regression  # of the logarithm of their squared distance from it

    def __call__(self, features: Floats) -> tuple[Floats, Floats]:
        """Return middles and spreads (m, p) for records with these features (m, f)."""
        new = self.standard.scores(np.atleast_2d(features))
        spread = np.exp(0.5 * self.spread.predict(new, self.scores))
        return self.middle.predict(new, self.scores), spread

    @property
    def library(self) -> tuple[Floats, Floats]:
        """Leave-one-out middles and spreads (n, p) of the library's own records."""
        return self.middle.library, np.exp(0.5 * self.spread.library)


def learn(features: Floats, parameters: Floats, progress: Progress = silent) -> FeatureSummary:
    """Learn the summary of a library: features (n, f) and parameters (n, p)."""
    standard = Standard.of(features)
    scores = standard.scores(features)
    with single_threaded_algebra():
        parts = [(width, *decompose(kernel(scores, scores, width))) for width in WIDTHS]
        first = regression(parts, parameters, scores.shape[1])
        middle = adapt_metrics(first, scores, parameters, part(progress, 4, 10, of=6))
        apart = parameters - middle.library
        spread = regression(parts, np.log(apart * apart + LEAST_SQUARE), scores.shape[1])
    return FeatureSummary(standard, scores, middle, spread)


def estimate(scores: Floats, targets: Floats, progress: Progress = silent) -> Regression:
    """Learn a regression of targets (n, p) over standardised features (n, f), a metric for each."""
    with single_threaded_algebra():
        only = WIDTHS[0], *decompose(kernel(scores, scores, WIDTHS[0]))
        first = regression([only], targets, scores.shape[1])
        return adapt_metrics(first, scores, targets, part(progress, 3, 10, of=7))


def as_arrays(**parts: Standard | Regression) -> dict[str, Floats]:
    """Return the fields of named parts as they are stored: ``standard_middle``, and so on."""
    pairs = ((name, part._asdict()) for name, part in parts.items())
    return {f"{name}_{field}": value for name, its in pairs for field, value in its.items()}


def from_arrays(name: str, fields: Sequence[str], arrays: Mapping[str, Floats]) -> list[Floats]:
    """Return the fields of a stored part; raise a KeyError if one is missing."""
    return [arrays[f"{name}_{field}"] for field in fields]


def read_regressions(
    arrays: Mapping[str, Floats], features: Floats, *names: str
) -> tuple[Standard, list[Regression]]:
    """Return stored regressions over these features (n, f); raise a KeyError without them."""
    standard = Standard(*from_arrays("standard", Standard._fields, arrays))
    found = [Regression(*from_arrays(name, Regression._fields, arrays)) for name in names]
    same = standard.middle.shape == features.shape[1:]
    if not same or any(len(each.library) != len(features) for each in found):
        raise KeyError(names)
    return standard, found


def single_threaded_algebra() -> AbstractContextManager[object]:
    """Keep NumPy's and SciPy's linear algebra to one thread, in all threads of the process.

    Those of OpenBLAS wait for each other in a busy loop: learning took four times as long with two
    on a machine of two cores that had other work to do, and as long where it had none.
    """
    limits: AbstractContextManager[object] = threadpool_limits(1, user_api="blas")
    return limits


def regression(
    parts: Sequence[tuple[float, Floats, Floats]], targets: Floats, features: int
) -> Regression:
    """Return the regression with the widths and ridges that predict left-out records best."""
    mean = targets.mean(axis=0)
    centred = targets - mean
    best = np.full(targets.shape[1], np.inf)
    width, chosen = np.empty_like(best), np.empty_like(best)
    weights, library = np.empty_like(targets), np.empty_like(targets)
    for trial, values, vectors in parts:
        for ridge, tried, left_out in ridges(values, vectors, centred):
            error = ((left_out - centred) ** 2).mean(axis=0)
            better = error < best
            best[better], width[better], chosen[better] = error[better], trial, ridge
            weights[:, better], library[:, better] = tried[:, better], left_out[:, better]
    return Regression(width, chosen, np.eye(features)[None], weights, mean, library + mean)


def adapt_metrics(
    first: Regression, scores: Floats, targets: Floats, progress: Progress
) -> Regression:
    """Return a regression in which a target has its own metric, if that predicts it better.

    A metric that has seen a record would predict it too well, and new ones worse. So each half of
    the library is predicted with the metric that the other half taught.
    """
    weights, library = first.weights.copy(), first.library.copy()
    metric = np.repeat(first.metric, targets.shape[1], axis=0)
    even = np.arange(len(scores)) % 2 == 0
    for i, target in enumerate((targets - first.mean).T):
        progress(i / targets.shape[1])
        if error(first.library[:, i], targets[:, i]) > UNKNOWN * target.var():
            continue  # no metric helps, and this is what learning takes most of its time for
        width, ridge = first.width[i], first.ridge[i]
        left_out = np.empty_like(target)
        for half in (even, ~even):
            own = metric_of(scores[half], target[half], width, 0.5 * ridge)
            seen = scores @ own
            tried, predicted = solve(kernel(seen, seen, width), FINER * ridge, target)
            left_out[~half] = predicted[~half]
        better = left_out + first.mean[i]
        if error(better, targets[:, i]) < error(first.library[:, i], targets[:, i]):
            weights[:, i], library[:, i], metric[i] = tried, better, own
    return first._replace(metric=metric, weights=weights, library=library)


def error(found: Floats, truth: Floats) -> float:
    """Return the mean squared error."""
    return float(((found - truth) ** 2).mean())


def metric_of(scores: Floats, target: Floats, width: float, ridge: float) -> Floats:
    """Return the metric (f, f) of one target: the root of the mean outer product of gradients.

    Of the prediction at each record with these scores; its trace is that of the first metric.
    """
    weights, _ = solve(kernel(scores, scores, width), ridge, target)
    count = scores.shape[1]
    pull = gaussian(scores, scores, width) * weights
    gradients = (pull @ scores - scores * pull.sum(axis=1)[:, None]) / (count * width**2)
    gradients += STRAIGHT / count * (weights @ scores)
    values, vectors = eigh(gradients.T @ gradients)
    sizes = np.sqrt(np.maximum(values, 0.0))
    sizes *= (count / max((sizes * sizes).sum(), LEAST_SQUARE)) ** 0.5
    return np.asarray((vectors * sizes) @ vectors.T + ROUND * np.eye(count))


def kernel(a: Floats, b: Floats, width: float) -> Floats:
    """Return the covariance of two sets of records: a linear and a Gaussian kernel.

    Distances are relative to the square root of the number of features.
    """
    found: Floats = STRAIGHT / a.shape[1] * (a @ b.T) + gaussian(a, b, width)
    return found


def gaussian(a: Floats, b: Floats, width: float) -> Floats:
    """Return the Gaussian kernel alone."""
    square = (a * a).mean(axis=1)[:, None] + (b * b).mean(axis=1)[None, :]
    square -= 2.0 / a.shape[1] * (a @ b.T)
    return np.asarray(np.exp(-0.5 * np.maximum(square, 0.0) / width**2))


def decompose(matrix: Floats) -> tuple[Floats, Floats]:
    """Return the eigenvalues, negative ones raised to zero, and the eigenvectors."""
    values, vectors = np.linalg.eigh(matrix)  # SciPy's holds Python back, a progress bar too
    return np.maximum(values, 0.0), vectors


def ridges(
    values: Floats, vectors: Floats, targets: Floats
) -> Iterator[tuple[float, Floats, Floats]]:
    """Yield, for each ridge, the weights and the leave-one-out predictions of all records.

    The latter in closed form (G. H. Golub, M. Heath & G. Wahba, Technometrics 21, 215 (1979)).
    """
    turned = vectors.T @ targets
    squares = vectors * vectors
    for ridge in RIDGES * len(values):
        inverse = 1.0 / (values + ridge)
        weights = vectors @ (inverse[:, None] * turned)
        yield float(ridge), weights, targets - weights / (squares @ inverse)[:, None]


def solve(matrix: Floats, ridge: float, target: Floats) -> tuple[Floats, Floats]:
    """Return weights and leave-one-out predictions for one target (n,) and one ridge."""
    factor, _ = dpotrf(matrix + ridge * np.eye(len(matrix)), lower=True, overwrite_a=True)
    weights, _ = dpotrs(factor, target, lower=True)
    inverse, _ = dtrtri(factor, lower=True, overwrite_c=True)
    return weights, target - weights / np.einsum("ij,ij->j", inverse, inverse)
