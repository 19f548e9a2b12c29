"""Regression-adjusted ABC against posteriors known in closed form."""

import numpy as np
import pytest
from scipy.stats import kstest

from stiction.inference.learning.regression_abc import posterior, quantiles, rank
from stiction.inference.learning.summary import learn

COUNT, ERROR = 1500, 0.5


def draw(random, count):
    """Return parameters and summaries of a linear model with normal errors."""
    z = random.standard_normal((count, 2))
    seen = np.column_stack([z[:, 0] + 0.5 * z[:, 1], z[:, 1]])
    return z, seen + ERROR * random.standard_normal(seen.shape)


def exact(seen):
    """Return mean and covariance of the posterior of the linear model."""
    design = np.array([[1.0, 0.5], [0.0, 1.0]])
    covariance = np.linalg.inv(np.eye(2) + design.T @ design / ERROR**2)
    return covariance @ design.T @ seen / ERROR**2, covariance


def test_the_posterior_is_that_of_the_linear_model():
    z, seen = draw(np.random.default_rng(1), 20000)
    observed = np.array([0.8, -0.4])
    found = posterior(seen, z, observed)
    mean, covariance = exact(observed)
    means = found.weights @ found.scores
    apart = found.scores - means
    # some 2500 effective draws: errors of 2 % of a standard deviation; four of them
    assert means == pytest.approx(mean, abs=4 * 0.02 * 0.45)
    assert (apart * found.weights[:, None]).T @ apart == pytest.approx(covariance, abs=0.02)


@pytest.fixture(scope="module")
def trials():
    """Ranks, and whether 95 % intervals hold the truth, of 300 records not in the library.

    Fifteen features are nonlinear functions of the two summaries with further errors.
    """
    random = np.random.default_rng(2)

    def features(seen):
        some = [seen, np.tanh(seen), seen**2, np.exp(0.3 * seen), seen[:, ::-1] * seen]
        noise = random.standard_normal((len(seen), 5))
        return np.hstack([*some, noise])

    z, seen = draw(random, COUNT)
    summary = learn(features(seen), z)
    truth, new = draw(random, 300)
    around, spreads = summary.library
    middles, widths = summary(features(new))
    tails = np.array([0.025, 0.975])
    ranks, inside = [], []
    for true, middle, width in zip(truth, middles, widths, strict=True):
        found = posterior(around, z, middle, (spreads, width))
        columns = [(found.scores[:, i], found.weights) for i in range(2)]
        ranks.append([rank(*each, true[i]) for i, each in enumerate(columns)])
        ends = [quantiles(*each, tails) for each in columns]
        inside.append([low <= true[i] <= high for i, (low, high) in enumerate(ends)])
    return np.array(ranks), np.array(inside)


def test_intervals_of_95_percent_hold_the_truth_as_often(trials):
    _, inside = trials
    # binomial: 300 trials, standard deviation 1.3 %; three of them
    assert inside.mean(axis=0) == pytest.approx(0.95, abs=0.038)


def test_ranks_of_the_truth_are_uniform(trials):
    ranks, _ = trials
    assert [kstest(ranks[:, i], "uniform").pvalue > 0.01 for i in range(2)] == [True, True]


def test_intervals_without_the_scatter_would_be_too_narrow(trials):
    """The check of the coverage can fail: half the scatter holds the truth too rarely."""
    z, seen = draw(np.random.default_rng(3), COUNT)
    truth, new = draw(np.random.default_rng(4), 300)
    summary = learn(seen, z)
    around, spreads = summary.library
    held = 0
    for true, middle, width in zip(truth, *summary(new), strict=True):
        found = posterior(around, z, middle, (spreads, 0.5 * width))
        low, high = quantiles(found.scores[:, 0], found.weights, np.array([0.025, 0.975]))
        held += low <= true[0] <= high
    assert held / 300 < 0.85
