"""Posteriors of a model in which features tell much here and little there, and askew."""

import numpy as np
import pytest
from scipy.special import ndtr
from scipy.stats import kstest

from stiction.inference.learning import calibration
from stiction.inference.learning.calibration import learn_or_read, read, read_summary
from stiction.inference.learning.regression_abc import Known, marginal, quantiles, rank

PARAMETERS = 4


def draw(seed, count):
    """Return features and truth: noise that grows 20 times over the prior, bounds, a nuisance."""
    random = np.random.default_rng(seed)
    z, e = random.standard_normal((count, PARAMETERS)), random.standard_normal((count, PARAMETERS))
    u = ndtr(z)
    seen = u[:, [1]] + 0.1 * random.standard_normal((count, 1))
    noise = 0.02 * 20.0 ** u[:, [1]] * np.where(e > 0.0, 2.0 * e, 0.5 * e)
    columns = [u + noise, (u + noise) ** 2, u[:, [0]] * u[:, [2]] + noise[:, [3]], seen]
    return np.concatenate([*columns, random.standard_normal((count, 6))], axis=1), z


@pytest.fixture(scope="module")
def learned():
    return learn_or_read(*draw(1, 1500))


@pytest.fixture(scope="module")
def unseen():
    """Few beside the library, whose own chance counts too."""
    return draw(2, 200)


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


def test_a_posterior_has_the_shape_of_the_errors_near_it():
    """Errors are exponential, with the tail above for positive estimates and below for others."""
    random = np.random.default_rng(4)
    middles = random.uniform(-2.0, 2.0, 4000)
    errors = np.sign(middles) * (random.exponential(1.0, 4000) - 1.0)
    found = marginal(Known(middles, np.full(4000, 0.1), middles + 0.1 * errors), 1.0, 0.1)
    low, high = quantiles(found.scores[:, 0], found.weights, np.array([0.025, 0.975]))
    # some 330 effective records: standard errors of these quantiles are 0.001 and 0.034; four each
    assert low == pytest.approx(1.0 + 0.1 * (-np.log(0.975) - 1.0), abs=0.004)
    assert high == pytest.approx(1.0 + 0.1 * (-np.log(0.025) - 1.0), abs=0.14)


def test_ranks_of_the_library_itself_are_uniform_and_give_the_coverage(learned):
    assert learned.ranks.shape == (500, PARAMETERS)
    assert min(kstest(column, "uniform").pvalue for column in learned.ranks.T) > 0.01
    # binomial: 500 trials, standard deviation 1.0 %; four of them
    assert learned.coverage(0.95) == pytest.approx(np.full(PARAMETERS, 0.95), abs=0.04)


def test_a_metric_of_its_own_ignores_what_says_nothing(learned):
    """The last six features are noise."""
    columns = np.abs(learned.summary.middle.metric[0])
    assert columns[-6:, -6:].max() < 0.3 * columns[:8, :8].max()


def test_what_was_learned_is_read_again(learned, tmp_path, monkeypatch):
    features, truth = draw(1, 1500)
    path = tmp_path / "learned.npz"
    assert read_summary(path, features) is None
    small = features[:400], truth[:400]
    first = learn_or_read(*small, path)
    with monkeypatch.context() as patch:
        for name in ("learn", "ranks", "Expectation"):
            patch.setattr(calibration, name, None)
        again = learn_or_read(*small, path)  # read
    assert np.array_equal(first.ranks, again.ranks)
    pairs = zip(first.posteriors(features[-3:]), again.posteriors(features[-3:]), strict=True)
    assert all(np.array_equal(a.scores, b.scores) for a, b in pairs)
    new = learned.summary.standard.scores(features[-9:])
    assert np.array_equal(first.typicality.farther(new), again.typicality.farther(new))
    assert read_summary(path, features) is None  # of another library
    assert read(path.with_name("learned-calibration.npz"), learned.summary) is None
