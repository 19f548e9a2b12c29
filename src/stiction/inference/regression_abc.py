"""Regression-adjusted approximate Bayesian computation: from simulated records to a posterior.

Of all simulated records those nearest to the measured one are kept, and their parameters shifted to
where they would lie if the summaries agreed, by a local regression whose weights fall off as
Epanechnikov's kernel (M. A. Beaumont, W. Zhang & D. J. Balding, Genetics 162, 2025 (2002)); their
scatter about it is rescaled to that expected for the measured record (M. G. B. Blum & O. Francois,
Stat. Comput. 20, 63 (2010)).

Parameters are normal scores: standard normal by the prior, so that no bound is ever crossed and all
are alike.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

SHARE = 0.25  # of the library that is near
FEWEST = 200  # of its records, which a local regression needs
FARTHEST = 6.0  # standard deviations of the prior: no adjusted score lies beyond
SCALE = 0.1, 10.0  # bounds of the rescaling
RIDGE = 1e-6


class Sample(NamedTuple):
    """A weighted sample of a posterior: normal scores (n, p) and weights (n,), whose sum is 1."""

    scores: Floats
    weights: Floats


def posterior(
    summaries: Floats,
    scores: Floats,
    observed: Floats,
    spreads: tuple[Floats, Floats] | None = None,
    weights: Floats | None = None,
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
    weights : ndarray, optional
        (n,), prior density over the density from which the records were drawn; 1 by default.

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
    count = min(max(int(SHARE * len(distance)), FEWEST), len(distance))
    near = np.argpartition(distance, count - 1)[:count]
    edge = distance[near].max()
    kernel = 1.0 - (distance[near] / edge) ** 2 if edge > 0.0 else np.ones(count)  # Epanechnikov
    share = kernel if weights is None else kernel * weights[near]
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


def local_regression(columns: Floats, values: Floats, weights: Floats) -> Floats:
    """Return the coefficients of a weighted linear regression."""
    weighted = columns * weights[:, None]
    square = weighted.T @ columns
    square += RIDGE * np.diag(np.diag(square))
    return np.asarray(np.linalg.solve(square, weighted.T @ values), dtype=np.float64)


def leverage(columns: Floats, weights: Floats) -> Floats:
    """Return the share of each value in its own prediction by a weighted linear regression."""
    weighted = columns * weights[:, None]
    square = weighted.T @ columns
    square += RIDGE * np.diag(np.diag(square))
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
