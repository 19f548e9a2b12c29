"""The slip coordinate, its inverse, its slope, and the update that inertia damps."""

from math import asinh, cosh, exp, factorial, hypot, inf, sinh, tanh

import numpy as np
import pytest
from scipy.optimize import brentq
from tests.entry import plain

from stiction.solver.smooth import coordinate as of
from stiction.solver.smooth.coordinate import (
    LARGEST_ARGUMENT,
    coordinate,
    damped_rise,
    slip_and_slope,
    slip_at,
)

EPS = 1e-9
POINTS = [(0.0, 0.0), (3e-5, -4e-5), (0.3, 0.4), (-3.0, 4.0), (30.0, 0.0), (0.0, -200.0)]


@pytest.mark.parametrize("q", POINTS)
def test_there_and_back(q):
    """(M64), near zero and over many decades."""
    s, size = plain(slip_at)(EPS, *q), hypot(*q)
    wanted = EPS * sinh(size) / size if size else 0.0
    assert s == pytest.approx((wanted * q[0], wanted * q[1]), rel=1e-13)
    assert plain(coordinate)(EPS, *s) == pytest.approx(q, rel=1e-12)
    assert plain(slip_at)(inf, *q) == plain(coordinate)(inf, *q) == q
    assert plain(slip_and_slope)(inf, *q) == (*q, 1.0, 0.0, 1.0)


def test_slip_that_is_no_float_is_the_largest_that_is():
    assert plain(slip_at)(1.0, 800.0, 0.0)[0] == pytest.approx(sinh(LARGEST_ARGUMENT))
    tiny = plain(coordinate)(1e-200, 3e-200, 4e-200)  # whose squares are none
    assert tiny == pytest.approx((0.6 * asinh(5.0), 0.8 * asinh(5.0)))


@pytest.mark.parametrize("q", [(0.0, 0.0), (3e-5, -4e-5), (0.3, 0.4), (-3.0, 4.0), (12.0, 5.0)])
def test_the_slope(q):
    """(M65), with its parts along q and across it: eps cosh and eps sinh(q)/q."""
    xx, xy, yy = np.array(plain(slip_and_slope)(EPS, *q)[2:]) / EPS
    found, size = np.array([[xx, xy], [xy, yy]]), hypot(*q)
    if size == 0.0:
        assert found == pytest.approx(np.eye(2))
        return
    along, across = np.array(q) / size, np.array([-q[1], q[0]]) / size
    assert found @ along == pytest.approx(cosh(size) * along, rel=1e-13)
    assert found @ across == pytest.approx(sinh(size) / size * across, rel=1e-13)


def test_nothing_jumps_where_the_series_end():
    """Of twenty terms, as many as a float has digits for; (cosh q - sinh(q)/q)/q^2 loses some."""
    q = of.SMALL
    slip = sum(q ** (2 * k + 1) / factorial(2 * k + 1) for k in range(20))
    along = sum(q ** (2 * k) / factorial(2 * k) for k in range(20))
    for part in (1.0 - 1e-15, 1.0 + 1e-15):
        x, y, xx, xy, yy = plain(slip_and_slope)(1.0, part * q, 0.0)
        assert (x, y, xy) == (pytest.approx(slip, rel=4e-15), 0.0, 0.0)
        assert (xx, yy) == pytest.approx((along, slip / q), rel=4e-15)


@pytest.mark.parametrize("q", [0.0, 0.5, 3.0, 40.0, 690.0])
@pytest.mark.parametrize("rise", [0.2, 5.0, 1e3])
@pytest.mark.parametrize("share", [0.0, 1e-6, 0.5, 1.0])
def test_a_damped_update(q, rise, share):
    """(M69), to a thousandth, as far as floats go; a small rise is taken as it is."""
    up = plain(damped_rise)(q, rise, share)
    assert up >= q
    assert plain(damped_rise)(q, 0.09, share) == q + 0.09

    def left(y):  # over cosh q, without overflow
        grown = (exp(y - q) - exp(-y - q)) / (1.0 + exp(-2.0 * q)) - tanh(q)
        return share * grown + (1.0 - share) * (y - q) - rise

    if left(LARGEST_ARGUMENT - 1.0) > 0.0:
        assert up == pytest.approx(brentq(left, q, LARGEST_ARGUMENT - 1.0), abs=2e-3)
    else:
        assert up >= LARGEST_ARGUMENT - 1.0
