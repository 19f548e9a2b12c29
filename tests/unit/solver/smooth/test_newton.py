"""The equations of one axis, corrections of the slip coordinate, and first guesses."""

from math import asinh, hypot, inf

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from tests.drawn import inside
from tests.entry import plain
from tests.unit.solver.systems import problem_of

from stiction.solver.radau import A, C, D
from stiction.solver.smooth import error_estimate, newton, right_hand_side, step
from stiction.solver.smooth.coordinate import risen
from stiction.solver.smooth.right_hand_side import Outset
from stiction.solver.smooth.workspace import START, workspace

A, C, D = np.array(A), np.array(C), np.array(D)
NODES = np.array([0.0, *C])
ROWS = [np.array(each) for each in inside(3, *[(-1.0, 1.0)] * 12)]


@pytest.mark.parametrize("row", ROWS)
def test_the_residuals_along_an_axis(row):
    """(M66): without slip a acts; springs and damper take from it what has slipped."""
    h, k, c, start = 0.3, 7.0, 1.3, row[0]
    s, a, f = row[1:4], row[4:7], row[7:10]
    part = plain(newton.linear)(h, k, c, start, tuple(a))
    wanted = D @ (s - start) - h * (a - k * h * (A @ s) - c * s - f)
    found = plain(newton.residual)(part, h, tuple(s), start, tuple(f))
    assert found == pytest.approx(wanted, abs=1e-13)
    by, slope = row[1:4], row[7:10]
    block = np.array(plain(newton.block)(part.by_slip, tuple(by), h, tuple(slope)))
    wanted = (D + h * h * k * A + h * c * np.eye(3)) @ np.diag(by) + h * np.diag(slope)
    assert block == pytest.approx(wanted, abs=1e-13)


def test_corrections_of_the_slip_velocity():
    """Without a logarithm: as they are, relative to the slip speed and what is resolved."""
    start = Outset(0.0, 0.0, 0.0, inf, 1e-6, 1.0)
    found = plain(newton.corrected)(start, 0.5, 1e-3, 3e-3, 4e-3, 3e-4, -4e-4)
    assert (found.q_x, found.q_y) == pytest.approx((2.7e-3, 4.4e-3))
    assert found.size == pytest.approx(5e-4 / (1e-3 + 5e-3))
    assert found.turn == pytest.approx(5e-4 / (1e-6 + 5e-3))


@pytest.mark.parametrize("share", [0.3, 1.0])
def test_corrections_of_its_logarithm(share):
    """A rise of more than 0.1 is damped by (M69), and the direction stays."""
    start = Outset(0.0, 0.0, 0.0, 1e-9, 0.2, 1.0)
    for d, damped in (((-3.0, -4.0), True), ((0.3, 0.4), False), ((-0.03, -0.04), False)):
        found = plain(newton.corrected)(start, share, 1e-3, 3.0, 4.0, *d)
        plainly = 3.0 - d[0], 4.0 - d[1]
        size = hypot(*d) / 1.0
        assert found.size == found.turn == pytest.approx(size)
        if damped:
            to = plain(risen)(5.0, hypot(*plainly) - 5.0, share)
            assert hypot(found.q_x, found.q_y) == pytest.approx(to)
            assert found.q_x / found.q_y == pytest.approx(plainly[0] / plainly[1])
            assert to < hypot(*plainly)
        else:
            assert (found.q_x, found.q_y) == pytest.approx(plainly)
    near = plain(newton.corrected)(start, share, 1e-3, 0.03, 0.04, 0.01, 0.0)
    assert near.size == pytest.approx(0.01 / (0.2 + 0.05))


def test_what_is_no_number_is_larger():
    larger = plain(newton.larger)
    assert (larger(1.0, 2.0), larger(2.0, 1.0), larger(1.0, 1.0)) == (2.0, 2.0, 1.0)
    assert np.isnan(larger(np.nan, 1.0))


@pytest.mark.parametrize("q", [(0.3, -0.4), (2.0, 1.0)])
def test_the_share_of_inertia(q):
    """(M69): along q, of the diagonal of the equations; all of it where friction weakens."""
    problem, h, a = problem_of("steady"), 0.01, 3.2
    s, f = np.array([[2.0, 0.3], [0.3, 1.5]]), np.array([[40.0, 5.0], [9.0, 70.0]])
    e = np.array(q) / hypot(*q)
    damping = e @ np.diag([3.0, 20.0]) @ e / 0.25
    inertia = a * (e @ s @ e) * (1 + h * damping)
    triples = [(m[0, 0], 0.5 * (m[0, 1] + m[1, 0]), m[1, 1]) for m in (s, f)]
    share = plain(right_hand_side.inertia_share)
    found = share(problem, h, a, q, *triples)
    assert found == pytest.approx(inertia / (inertia + h * (e @ f @ e)))
    weakening = tuple(-each for each in triples[1])
    assert share(problem, h, a, q, triples[0], weakening) == 1.0
    assert share(problem, h, a, (0.0, 0.0), *triples) == 1.0


@pytest.mark.parametrize("warm", [True, False])
def test_a_first_guess_is_the_last_step_continued(warm):
    """Cubics exactly; at rest where the slip would turn back; else what held at the start."""
    w, x = plain(workspace)(1), 0.6
    along, state = Polynomial([1.0, 0.4, -0.2, 0.1]), Polynomial([3.0, -1.0, 0.5, 0.2])
    w.past[:] = np.transpose([along(NODES), -0.5 * along(NODES), state(NODES)])
    w.values[START] = 0.7, -0.35, 9.0
    q_x, q_y = plain(step.predict)(w, 0.7, -0.35, x, warm)
    if warm:
        there = 1.0 + x * C
        assert q_x == pytest.approx(along(there))
        assert q_y == pytest.approx(-0.5 * along(there))
        assert w.values[1:4, 2] == pytest.approx(state(there))
        back = plain(step.predict)(w, -0.7, 0.35, x, True)
        assert back == ((0.0,) * 3, (-0.0,) * 3)
    else:
        assert (q_x, q_y) == ((0.7,) * 3, (-0.35,) * 3)
        assert w.values[1:4, 2].tolist() == [9.0] * 3


def test_the_last_step_is_remembered_in_the_slip_coordinate():
    w, eps = plain(workspace)(1), 1e-9
    past = np.array([[3e-6, 4e-6, 1.0], [0.0, 0.0, 2.0], [1e-3, 0.0, 3.0], [0.0, -1e-3, 4.0]])
    plain(step.remember)(w, past, eps)
    assert w.past[:, 2].tolist() == [1.0, 2.0, 3.0, 4.0]
    assert w.past[0, :2] == pytest.approx([0.6 * asinh(5e-6 / eps), 0.8 * asinh(5e-6 / eps)])
    assert w.past[1, :2].tolist() == [0.0, 0.0]
    assert w.past[2:, :2] == pytest.approx(asinh(1e-3 / eps) * np.array([[1, 0], [0, -1]]))


@pytest.mark.parametrize("c", [0.2, 0.4, 1.0])
def test_the_polynomials_inside_a_step_and_their_error(c):
    """Value, derivative and integral; the error goes as Pi(c)/|Pi(c_1)|, but for the distance."""
    w = plain(workspace)(1)
    x, y, z = (Polynomial(row[4 * i : 4 * i + 4]) for i, row in enumerate([ROWS[0]] * 3))
    w.values[:4] = np.transpose([each(NODES) for each in (x, y, z)])
    found = plain(error_estimate.within)(w, c)
    quadratics = [Polynomial.fit(C, each(C), 2, domain=[-1, 1]).convert() for each in (x, y)]
    slid = [each.integ()(c) for each in quadratics]
    wanted = x(c), y(c), x.deriv()(c), y.deriv()(c), *slid
    assert found == pytest.approx(wanted, abs=1e-12)
    assert w.cubic[:, 2] == pytest.approx([z(c), z.deriv()(c)], abs=1e-12)
    w.error[:] = 0.3, -0.2, 0.7
    pi = Polynomial.fromroots(C).integ()
    shape = pi / abs(pi(C[0]))
    less = plain(error_estimate.less_error)(w, found, c)
    off = *(w.error[:2] * shape(c)), *(w.error[:2] * shape.deriv()(c)), 0.0, 0.0
    assert less == pytest.approx(np.array(wanted) - off, abs=1e-12)
    assert w.cubic[:, 2] == pytest.approx(
        [z(c) - 0.7 * shape(c), z.deriv()(c) - 0.7 * shape.deriv()(c)], abs=1e-12
    )
