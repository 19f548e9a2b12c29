"""Times of samples."""

import numpy as np
import pytest

import stiction as st
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


def test_times_that_run_backwards_are_named(tmp_path):
    """A file with its last sample first had "fewer than 2 samples"."""
    path = tmp_path / "data.csv"
    path.write_text("t (s),F (N)\n" + "".join(f"{t},1.0\n" for t in range(9, -1, -1)))
    with pytest.raises(st.ResultError, match="backwards, from 9 s to 0 s; put the lines in order"):
        st.read_record(path)


def test_a_misspelt_argument_is_compared_with_all_arguments(tmp_path):
    """`stifness` was meant to be `times`."""
    path = tmp_path / "data.csv"
    path.write_text("t (s),F (N)\n0,1\n1,2\n")
    with pytest.raises(st.StictionError, match=r"unknown argument 'stifness'; .* 'stiffness'"):
        st.read_record(path, stifness="1 N/m")
