"""The exploration of tolerance budgets: what it counts, and when it calls a column wrong."""

from math import nan

import numpy as np
import pytest
from benchmarks.explore.audits.budgets import Seen, inside, summary

from stiction.auditing.tolerance import Alignment, Budget


def budget_of(drawn):
    angles, none = np.zeros(len(drawn)), np.zeros((1, 4))
    return Budget(angles, drawn, np.zeros(1), none, none[0], Alignment(nan, 1.0, 0.0), ())


def test_the_share_of_tests_in_an_interval_is_counted_where_it_is_wide_and_of_95_percent():
    drawn = np.tile(np.linspace(0.0, 1.0, 64)[:, np.newaxis], 4)
    drawn[10:, 2] = nan  # ten tests creep
    drawn[:, 1] = 1.0 + 5e-4 * drawn[:, 1]  # too narrow for its digits
    others = np.tile(np.linspace(-1.0, 1.0, 200)[:, np.newaxis], 4)
    others[:, 3] = nan
    low, high = budget_of(drawn).intervals[:, 0]
    shares = inside(budget_of(drawn), others)
    assert shares[0] == pytest.approx(0.5 * (high - low), abs=0.01)
    assert np.isnan(shares[1:]).all()


@pytest.mark.parametrize(("share", "wrong"), [(0.95, 0), (0.94, 0), (0.90, 1), (0.999, 1)])
def test_a_column_that_holds_too_few_or_too_many_is_wrong(share, wrong, capsys):
    seen = [Seen(i, "a rig", (share, share, nan, 0.95), 0.01, 0.03) for i in range(30)]
    assert summary(seen, 100) == wrong
    assert "alignment: 30 of 30" in capsys.readouterr().out


def test_an_angle_below_which_the_error_is_larger_than_allowed_is_wrong():
    seen = [Seen(i, "a rig", (0.95,) * 4, 0.01, 0.03) for i in range(30)]
    assert summary(seen, 100) == 0
    assert summary([*seen, seen[0]._replace(below=0.03)], 100) == 1
    assert summary([*seen, seen[0]._replace(above=0.01)], 100) == 1
