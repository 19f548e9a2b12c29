"""Polynomials that stand for many cycles."""

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from tests.entry import map_of, plain

from stiction.solver.multiscale import construction, interpolant
from stiction.solver.multiscale.interpolant import POINTS
from stiction.solver.multiscale.return_map import NEAR, NODES, Cycle

TURN, TIME = Polynomial([0.02, 0.004, -0.001, 0.0003]), Polynomial([2.0, -0.3, 0.05, 0.01])
SQUARE = Polynomial([0.5, 0.2, -0.03, 0.02])  # of the time held, s^2


def cycle(x):
    """Return the cycle from a place in the patch."""
    return Cycle(TURN(x), TIME(x), np.sqrt(SQUARE(x)))


def known_of(*starts, reach=0.5, n=4):
    """Return a map with patches of the same polynomials, and by what each node missed."""
    known, misses = map_of(1e-6), []
    for row, start in enumerate(starts):
        known.coefficients[row] = 0.0
        for i in range(n):
            coefficients = known.coefficients[row]
            misses.append(plain(construction.added_node)(coefficients, i, cycle(POINTS[i]), 0.1))
        known.patches[row] = start, 2.0 / reach, n
    known.sizes[0] = len(starts)
    return known, misses


def test_each_node_is_where_it_tells_most():
    """Leja points: the product of the distances to those before is largest; both ends first."""
    assert sorted(POINTS[:2]) == [-1.0, 1.0]
    grid = np.linspace(-1.0, 1.0, 4001)
    for i in range(2, NODES):
        products = np.abs(np.prod(grid[:, None] - POINTS[:i], axis=1))
        mine = abs(np.prod(POINTS[i] - POINTS[:i]))
        assert mine > 0.999 * products.max()


@pytest.mark.parametrize("n", [4, 5, 7])
@pytest.mark.parametrize("x", [-1.0, -0.3, 0.2, 1.0])
def test_the_polynomials_go_through_their_nodes(n, x):
    """Four nodes hold cubics exactly, and further ones change nothing."""
    known, _ = known_of(0.3, n=n)
    found = plain(interpolant.interpolate)(known.coefficients[0], n, x)
    assert found == pytest.approx((TURN(x), TIME(x), SQUARE(x)), abs=1e-13)
    assert plain(interpolant.cycle_from)(known, 0, x) == pytest.approx(cycle(x), abs=1e-13)


def test_a_node_tells_by_how_much_the_polynomials_missed_it():
    """(M57), of the cubics without their last coefficient at the fourth node; then of none."""
    _, misses = known_of(0.3, n=6)
    x = POINTS[3]
    off = []
    for polynomial in (TURN, TIME, SQUARE):
        lower = Polynomial.fit(POINTS[:3], polynomial(POINTS[:3]), 2, domain=[-1, 1])
        off.append(abs(polynomial(x) - lower(x)))
    _, time, held = cycle(x)
    wanted = off[0] / 0.1, off[1] / time, off[2] / (2 * NEAR * time * held)
    assert misses[3] == pytest.approx(max(wanted), rel=1e-9)
    assert max(misses[4:]) < 1e-12
    assert misses[0] == pytest.approx(1.0)  # the time is missed as a whole
    # beside a turn that is larger than that of the stick, and beside the time held
    for least, which in ((1e-9, 0), (1e9, 2)):
        known, _ = known_of(0.3, n=3)
        c = known.coefficients[0]
        node = Cycle(*cycle(x)) if which == 0 else Cycle(TURN(x), TIME(x), 3 * held)
        square = off[2] if which == 0 else abs(9 * SQUARE(x) - (SQUARE(x) - sign_of_cubic(x)))
        parts = (
            off[0] / max(abs(TURN(x)), least),
            off[1] / time,
            square / (2 * NEAR * time * node.held),
        )
        found = plain(construction.added_node)(c, 3, node, least)
        assert found == pytest.approx(max(parts), rel=1e-9)


def sign_of_cubic(x):
    """Return by what the cubic lies above the parabola through the first nodes."""
    lower = Polynomial.fit(POINTS[:3], SQUARE(POINTS[:3]), 2, domain=[-1, 1])
    return SQUARE(x) - lower(x)


def test_the_patch_of_an_angle():
    known, _ = known_of(0.3, 1.0)
    locate = plain(interpolant.locate)
    assert locate(known, 0.3) == (0, pytest.approx(-1.0))
    assert locate(known, 0.4) == (0, pytest.approx(-0.6))
    assert locate(known, 1.4999) == (1, pytest.approx(0.9996))
    assert locate(known, 0.29)[0] == locate(known, 0.81)[0] == locate(known, 1.51)[0] == -1
    assert locate(known, np.nan)[0] == -1


def test_a_square_below_zero_is_no_stick():
    known, _ = known_of(0.3)
    for square, held in ((100.0, 10.0), (-1.0, 0.0)):
        known.coefficients[0, :, 2] = [square, *[0.0] * (NODES - 1)]
        assert plain(interpolant.cycle_from)(known, 0, 0.0).held == held
