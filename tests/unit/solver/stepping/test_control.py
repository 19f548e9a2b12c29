"""When Newton's method ends, and how large the next step is: one set of rules for both solvers."""

import pytest
from tests.entry import plain

from stiction.solver.stepping import control


@pytest.mark.parametrize("error", [1e-3, 0.3, 1.0, 20.0])
def test_the_factor_for_the_step_size(error):
    """(M43): 0.9 of what would do for an error that falls with h^4, from 0.2 to a limit."""
    theta = (error + 1e-10) ** -0.25
    assert plain(control.ease)(error) == pytest.approx(theta, rel=1e-14)
    wanted = min(1.5, max(0.2, 0.9 * theta))
    assert plain(control.step_factor)(error, 1.5) == pytest.approx(wanted, rel=1e-14)
    assert plain(control.step_factor)(1e9, 1.5) == 0.2
    assert plain(control.ease)(0.0) == pytest.approx(1e-10**-0.25)


def test_the_trend_of_errors():
    """(M43): steps of one size, the error 16 times the last one's: the next is expected so too."""
    at_ease, before = 16.0**-0.25, 1.0
    assert plain(control.trend)(1.0, 1.0, at_ease, before) == pytest.approx(0.9 / 4.0)
    assert plain(control.trend)(2.0, 1.0, at_ease, before) == pytest.approx(0.9 / 2.0)
    assert plain(control.trend)(1.0, 1.0, 0.1, before) == 0.2


def test_corrections_settle_or_diverge():
    """(M33): the next one, in proportion, is what counts; NaN is neither small nor settled."""
    settled, diverging = plain(control.settled), plain(control.diverging)
    assert settled(1e-7, 0.5, 1e-6)
    assert settled(1e-4, 1e-3, 1e-6)
    assert not settled(1e-4, 0.1, 1e-6)
    assert not settled(float("nan"), float("nan"), 1e-6)
    assert diverging(4, 1.1)
    assert not diverging(3, 1.1)
    assert not diverging(9, 0.9)
