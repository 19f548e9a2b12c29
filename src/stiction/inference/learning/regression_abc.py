"""Regression-adjusted approximate Bayesian computation: from simulated records to a posterior.

Of all simulated records those nearest to the measured one are kept, and their parameters shifted to
where they would lie if the summaries agreed, by a local regression whose weights fall off as
Epanechnikov's kernel (M. A. Beaumont, W. Zhang & D. J. Balding, Genetics 162, 2025 (2002)); their
scatter about it is rescaled to that expected for the measured record (M. G. B. Blum & O. Francois,
Stat. Comput. 20, 63 (2010)).

With many parameters the nearest quarter of a library is not near, and residuals have another shape
there than at the measured record: ranks of the truth are not uniform. So each parameter's own
distribution comes from records that are near in what is known of this parameter alone, two numbers,
and only the dependence between parameters from the others (D. J. Nott, Y. Fan, L. Marshall & S. A.
Sisson, J. Comput. Graph. Stat. 23, 65 (2014)).

Parameters are normal scores: standard normal by the prior, so that no bound is ever crossed and all
are alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from stiction.arrays import Floats

SHARE = 0.25  # of the library that is near
FEWEST_RECORDS = 200  # of its records, which a local regression needs
FARTHEST = 6.0  # standard deviations of the prior: no adjusted score lies beyond
LEAST_SPREAD = 1e-9
SCALE = 0.1, 10.0  # bounds of the rescaling
RIDGE = 1e-6
NEAREST = 400  # records from which the distribution of one parameter comes
LESS = 0.7  # weight of a difference in the spread's logarithm beside one in the middle


class Sample(NamedTuple):
    """A weighted sample of a posterior: normal scores (n, p) and weights (n,), whose sum is 1."""

    scores: Floats
    weights: Floats


def posterior(
    summaries: Floats,
    scores: Floats,
    observed: Floats,
    spreads: tuple[Floats, Floats] | None = None,
) -> Sample:
    """Return a sample of the posterior of scores, given an observed summary.

    Parameters
    ----------
    summaries, scores : ndarray
        (n, q) and (n, p), of simulated records.
    observed : ndarray
        (q,), of the measured one.
    spreads : tuple of ndarray, optional
        (n, p) and (p,): how far scores scatter about their summaries, for each simulated record
        and for the measured one; by default alike for all.

    Examples
    --------
    A normal parameter, observed with an error of 0.5, has the posterior N(0.8 x, 0.2):

    >>> random = np.random.default_rng(1)
    >>> z = random.standard_normal((20000, 1))
    >>> found = posterior(z + 0.5 * random.standard_normal((20000, 1)), z, np.array([1.0]))
    >>> mean = found.weights @ found.scores[:, 0]
    >>> f"{mean:.2f} {(found.weights @ (found.scores[:, 0] - mean) ** 2) ** 0.5:.2f}"
    '0.80 0.44'
    """
    apart = summaries - observed
    distance = np.sqrt((apart * apart).sum(axis=1))
    count = min(max(int(SHARE * len(distance)), FEWEST_RECORDS), len(distance))
    near = np.argpartition(distance, count - 1)[:count]
    edge = distance[near].max()
    share = 1.0 - (distance[near] / edge) ** 2 if edge > 0.0 else np.ones(count)  # Epanechnikov
    kept = share > 0.0
    near, share = near[kept], share[kept] / share[kept].sum()
    columns = np.column_stack([np.ones(len(near)), apart[near]])
    middle = local_regression(columns, scores[near], share)
    residual = scores[near] - columns @ middle
    residual /= 1.0 - leverage(columns, share)[:, None]  # as from a regression without it
    if spreads is not None:
        residual *= np.clip(spreads[1] / spreads[0][near], *SCALE)
    adjusted = middle[0] + residual
    return Sample(np.clip(adjusted, -FARTHEST, FARTHEST), share)


class Known(NamedTuple):
    """The estimates and the true scores of one parameter of all simulated records, (n,) each.

    `middles` and `spreads` are estimates from the features, each without this record; `scores` the
    truth.
    """

    middles: Floats
    spreads: Floats
    scores: Floats


def marginal(known: Known, middle: float, spread: float, without: int | None = None) -> Sample:
    """Return a sample (m, 1) of one parameter's posterior, given its estimate.

    The distance of the truth from the estimate, over the spread, of the records with the nearest
    estimates and spreads, by a local linear regression. `without` leaves one record out.

    Examples
    --------
    Estimates that are too large by half a spread, wherever they lie:

    >>> random = np.random.default_rng(1)
    >>> m, e = random.standard_normal((2, 4000))
    >>> found = marginal(Known(m, np.full(4000, 0.2), m + 0.2 * (e - 0.5)), 1.0, 0.2)
    >>> f"{found.weights @ found.scores[:, 0]:.2f}"
    '0.90'
    """
    aside = np.log(known.spreads / spread)
    units = known.middles.std(), max(float(aside.std()), LEAST_SPREAD)
    apart = np.stack([(known.middles - middle) / units[0], LESS * aside / units[1]], axis=1)
    distance = (apart * apart).sum(axis=1)
    if without is not None:
        distance[without] = np.inf
    count = min(NEAREST, len(distance) - 1)
    near = np.argpartition(distance, count)[:count]
    share = 1.0 - distance[near] / distance[near].max()
    share = share / share.sum()
    residual = (known.scores - known.middles)[near] / known.spreads[near]
    columns = np.column_stack([np.ones(count), apart[near]])
    line = local_regression(columns, residual[:, None], share)
    scatter = (residual - (columns @ line)[:, 0]) / (1.0 - leverage(columns, share))
    values = np.clip(middle + spread * (line[0, 0] + scatter), -FARTHEST, FARTHEST)
    return Sample(values[:, None], share)


def with_marginals(joint: Sample, marginals: Sequence[Sample]) -> Sample:
    """Return a sample with the ranks of `joint` and the distributions of `marginals`."""
    columns = []
    for values, its in zip(joint.scores.T, marginals, strict=True):
        order = np.argsort(values)
        shares = np.empty_like(values)
        shares[order] = np.cumsum(joint.weights[order]) - 0.5 * joint.weights[order]
        columns.append(quantiles(its.scores[:, 0], its.weights, shares))
    return Sample(np.stack(columns, axis=1), joint.weights)


def normal_matrix(columns: Floats, weights: Floats) -> tuple[Floats, Floats]:
    """Return the weighted columns of a regression, and the matrix of its normal equations."""
    weighted = columns * weights[:, None]
    square = weighted.T @ columns
    return weighted, square + RIDGE * np.diag(np.diag(square)) + LEAST_SPREAD * np.eye(len(square))


def local_regression(columns: Floats, values: Floats, weights: Floats) -> Floats:
    """Return the coefficients of a weighted linear regression."""
    weighted, square = normal_matrix(columns, weights)
    return np.asarray(np.linalg.solve(square, weighted.T @ values), dtype=np.float64)


def leverage(columns: Floats, weights: Floats) -> Floats:
    """Return the weight of each value in its own prediction by a weighted linear regression."""
    weighted, square = normal_matrix(columns, weights)
    return np.asarray(np.einsum("ij,ij->i", weighted, np.linalg.solve(square, columns.T).T))


def quantiles(values: Floats, weights: Floats, shares: Floats) -> Floats:
    """Return quantiles of a weighted sample, by linear interpolation.

    >>> quantiles(np.array([3.0, 1.0, 2.0]), np.full(3, 1 / 3), np.array([0.5]))
    array([2.])
    """
    order = np.argsort(values)
    below = np.cumsum(weights[order]) - 0.5 * weights[order]
    return np.asarray(np.interp(shares, below, values[order]))


def rank(values: Floats, weights: Floats, truth: float) -> float:
    """Return the share of a weighted sample below a value."""
    return float(weights[values < truth].sum())
