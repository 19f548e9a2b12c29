"""Posteriors of a model in which features tell much here and little there, and askew."""

import numpy as np
import pytest
from scipy.special import ndtr
from scipy.stats import kstest

from stiction.inference.calibration import read, study
from stiction.inference.regression_abc import posterior, rank

PARAMETERS = 4


def draw(seed, count):
    """Return features and truth: noise that grows 20 times over the prior, bounds, a nuisance."""
    random = np.random.default_rng(seed)
    z, e = random.standard_normal((count, PARAMETERS)), random.standard_normal((count, PARAMETERS))
    u = ndtr(z)
    noise = 0.02 * 20.0 ** u[:, [1]] * np.where(e > 0.0, 2.0 * e, 0.5 * e)
    columns = [u + noise, (u + noise) ** 2, u[:, [0]] * u[:, [2]] + noise[:, [3]], u[:, [1]]]
    return np.concatenate([*columns, random.standard_normal((count, 6))], axis=1), z


@pytest.fixture(scope="module")
def learned():
    return study(*draw(1, 1500))


@pytest.fixture(scope="module")
def unseen():
    return draw(2, 500)


def p_values(samples, truth):
    ranks = [
        [
            rank(column, sample.weights, its)
            for column, its in zip(sample.scores.T, row, strict=True)
        ]
        for sample, row in zip(samples, truth, strict=True)
    ]
    return [kstest(column, "uniform").pvalue for column in np.array(ranks).T]


def test_ranks_of_the_truth_are_uniform_on_records_that_no_part_has_seen(learned, unseen):
    features, truth = unseen
    assert min(p_values(learned.posteriors(features), truth)) > 0.01


def test_they_are_not_without_the_distribution_of_each_parameter_by_itself(learned, unseen):
    """What the nearest quarter of a library says of all parameters at once is too coarse."""
    features, truth = unseen
    around, _ = learned.summary.library
    middles, _ = learned.summary(features)
    joint = [posterior(around, learned.truth, middle) for middle in middles]
    assert min(p_values(joint, truth)) < 1e-4


def test_ranks_of_the_library_itself_are_uniform_and_give_the_coverage(learned):
    assert learned.ranks.shape == (500, PARAMETERS)
    assert min(kstest(column, "uniform").pvalue for column in learned.ranks.T) > 0.01
    # binomial: 500 trials, standard deviation 1.0 %; four of them
    assert learned.coverage(0.95) == pytest.approx(np.full(PARAMETERS, 0.95), abs=0.04)


def test_a_metric_of_its_own_ignores_what_says_nothing(learned):
    """The last six features are noise."""
    columns = np.abs(learned.summary.middle.metric[0])
    assert columns[-6:, -6:].max() < 0.3 * columns[:8, :8].max()


def test_what_was_learned_is_read_again(learned, tmp_path):
    features, truth = draw(1, 1500)
    path = tmp_path / "learned.npz"
    assert read(path, features) is None
    small = features[:400], truth[:400]
    first, again = (study(*small, path) for _ in range(2))
    assert np.array_equal(first.ranks, again.ranks)
    pairs = zip(first.posteriors(features[-3:]), again.posteriors(features[-3:]), strict=True)
    assert all(np.array_equal(a.scores, b.scores) for a, b in pairs)
    assert read(path, features) is None  # of another library
