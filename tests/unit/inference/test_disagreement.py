"""Several records of a rig that contradict each other."""

import numpy as np
import pytest

from stiction.inference.disagreement import disagreement
from stiction.inference.learning.summary import learn

COUNT, NOISE = 600, 0.1
NAMES = ["phi", "mu_0"]


def records_of(truth: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Return features of a record: a curved one of phi, and mu_0 with noise that phi makes."""
    phi, mu = truth.T
    noise = NOISE * random.standard_normal((3, len(truth)))
    return np.stack([np.exp(phi) + noise[0], mu + np.exp(phi) * noise[1], phi * mu + noise[2]], 1)


@pytest.fixture(scope="module")
def library():
    random = np.random.default_rng(1)
    truth = random.standard_normal((COUNT, 2))
    return truth, [learn(records_of(truth, random), truth) for _ in range(2)]


def disagreements(library, first, second, count, seed=2):
    """Return how far pairs of records of rigs with these parameters disagree."""
    random = np.random.default_rng(seed)
    pairs = [
        records_of(np.tile(each, (count, 1)), random)
        for each in (np.array(first), np.array(second))
    ]
    return [disagreement(NAMES, *library, observed) for observed in zip(*pairs, strict=True)]


def test_records_of_one_rig_seldom_contradict_each_other(library):
    random = np.random.default_rng(3)
    truth = random.standard_normal((200, 2))
    both = zip(records_of(truth, random), records_of(truth, random), strict=True)
    shares = np.array([disagreement(NAMES, *library, each).p_value for each in both])
    assert (shares < 0.01).mean() <= 0.03
    assert (shares < 0.05).mean() <= 0.1


@pytest.mark.parametrize(
    ("second", "name"), [((-0.5, 0.0), "phi"), ((1.3, 0.0), "phi"), ((0.5, 1.5), "mu_0")]
)
def test_records_of_two_rigs_contradict_each_other(library, second, name):
    """The joint interval held neither truth, without a word: in 26 of 33 pairs of records."""
    found = disagreements(library, (0.5, 0.0), second, 20)
    assert np.mean([each.p_value < 0.01 for each in found]) > 0.8
    assert np.mean([each.name == name for each in found]) > 0.8
