"""Times of samples."""

import numpy as np
import pytest

from stiction.recording.guess.clock import rate_of

EVEN = np.arange(20_000) * 1e-3


@pytest.mark.parametrize(
    ("time", "rate", "rel"),
    [
        (EVEN, 1e3, 1e-12),
        (np.delete(EVEN, slice(9_000, 9_100)), 1e3, 1e-12),
        (np.delete(EVEN, [5, 700, 701, 15_000]), 1e3, 1e-3),  # 1 of 20 000 looks twice as long
        (np.round(np.arange(9_000) * 1.5e-3, 3), 1e3 / 1.5, 1e-4),  # a clock of whole ms
        (np.floor(EVEN * 100) / 100, 1e3, 1e-3),  # each time ten times
        (np.cumsum(np.random.default_rng(0).exponential(1e-3, 20_000)), 1e3, 0.03),
        (np.array([0.0, 1.0]), 1.0, 0.0),
        (np.array([0.0]), 0.0, 0.0),
        (np.array([]), 0.0, 0.0),
    ],
    ids=["even", "gap", "lost", "rounded", "tied", "random", "two", "one", "none"],
)
def test_gaps_do_not_change_the_rate(time, rate, rel):
    assert rate_of(time) == pytest.approx(rate, rel=rel)
