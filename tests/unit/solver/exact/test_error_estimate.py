"""The error of a step, under any drive and load, and the motion that it is relative to."""

from math import inf

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from tests.entry import plain
from tests.systems import SLIDERS
from tests.unit.solver.exact.test_collocation import A, C, begin
from tests.unit.solver.exact.test_newton import SLIDES

from stiction.solver.accuracy import Accuracy
from stiction.solver.exact import error_estimate, oscillation, slip_frame
from stiction.solver.exact.collocation import SlipStep

NODES = np.array([0.0, *C])
LAGRANGE = [Polynomial.fromroots(np.delete(C, j)) for j in range(3)]
LAGRANGE = [basis / basis(C[j]) for j, basis in enumerate(LAGRANGE)]
PI = Polynomial.fromroots(C)
FREE = 1e-6, 1e-3  # m/s
ACCURACY = Accuracy(1e-6, 1e-8, 1e-4, *FREE, inf, 2e-3, 2.5e-4, 6e-6, 0.0, 0.0, 1e-12)
ALL = pytest.mark.parametrize(("name", "drawn"), [(n, d) for n in SLIDERS for d in SLIDES])


@ALL
def test_the_motion_about_steady_sliding(name, drawn):
    """(M42)."""
    problem, frame, _, printed, _ = begin(name, drawn, "not")
    start, e = plain(slip_frame.outset)(problem, frame), printed.axes
    f, _ = printed.friction(frame.t, frame.r)
    n_1, tau = printed.friction_direction(0.0)
    s = e.T @ (printed.b(0.0) - printed.c @ [frame.r, 0.0] - f * np.array([n_1, tau]))
    change = printed.drive("rate", frame.t) - frame.r * e[0]
    curve = printed.drive("rate_change", frame.t) - s
    square = change @ change + curve**2 @ [ACCURACY.square_x, ACCURACY.square_y]
    found, apart = plain(error_estimate.moving)(problem, frame, start, ACCURACY)
    assert found == pytest.approx(np.sqrt(square), rel=1e-12)
    fast = min(ACCURACY.square_x, ACCURACY.square_y)
    assert apart == pytest.approx(change @ change + curve @ curve * fast, rel=1e-12)
    more = ACCURACY._replace(least=2 * found)
    assert plain(error_estimate.moving)(problem, frame, start, more)[0] == 2 * found


@ALL
@pytest.mark.parametrize("size", [0.02, 1.5, 2.6])
@pytest.mark.parametrize("motion", [1e-3, inf])
@pytest.mark.parametrize("accuracy", [ACCURACY, ACCURACY._replace(drive=inf, free_x=1.0)])
@pytest.mark.parametrize("turned_by", [1.0, 30.0])
def test_the_error_of_a_step(name, drawn, size, motion, accuracy, turned_by):
    """(M37), (M38) and (M41), at one point, or at two in a step longer than an oscillation."""
    problem, frame, o, printed, h = begin(name, drawn, "not")
    h *= size / 0.02
    laid = plain(oscillation.swings)(o, h)
    assert laid == (size == 1.5)
    swing = plain(oscillation.swing)(o, h, False)
    p, w = frame.r * np.array([1.05, 0.9, 0.95]), turned_by * np.array([0.02, -0.1, 0.15])
    after, found = plain(oscillation.after), []
    stiffest = max(frame.k_11, frame.k_22)
    assert size < 2.5 or stiffest * h * h > 6.25
    for c in (0.4, 0.85) if stiffest * h * h > 6.25 else (0.4,):
        gamma = abs(PI.integ()(C[0]) / PI(c))
        below = np.array([after(o, x * h) if laid else (0.0,) * 3 for x in (*NODES, c)]).T
        rest = Polynomial.fit(NODES, [frame.r, *p] - below[0, :4], 3, domain=[0, 1])
        turn = Polynomial.fit(NODES, [0.0, *w], 3, domain=[0, 1])
        integrals = np.array([basis.integ()(c) for basis in LAGRANGE])
        z = h * np.array([integrals @ (p - below[0, 1:4]), integrals @ (p * w)])
        z[0] += below[2, 4]
        p_in, p_c = rest(c) + below[0, 4], rest.deriv()(c) + h * below[1, 4]
        w_in, w_c = turn(c), turn.deriv()(c)
        s = p_in * np.array([1.0, w_in])
        a = printed.b(c * h) - printed.k @ z - printed.c @ s
        f, _ = printed.friction(frame.t + c * h, np.hypot(*s))
        n_1, tau = printed.friction_direction(w_in)
        dtau = (
            printed.friction_direction(w_in + 1e-6)[1] - printed.friction_direction(w_in - 1e-6)[1]
        ) / 2e-6
        off_p = p_c - h * (a[0] - f * n_1)
        off_w = p_in * w_c - h * (a[1] - w_in * a[0] - f * tau)
        off_w /= p_in + gamma * h * abs(a[0] + f * dtau)
        off = np.array([off_p, w_in * off_p + p_in * off_w]) @ printed.axes
        rates = np.abs(printed.drive("rate", frame.t + c * h) - s @ printed.axes)
        sigma, most = accuracy.speed, min(np.hypot(*s), accuracy.drive)
        S = min(sigma + most, motion)
        free = accuracy.free_x, accuracy.free_y
        axes = [min(sigma + min(most, v + own), motion) for v, own in zip(rates, free, strict=True)]
        turned = abs(off_w) * (sigma + np.hypot(*s)) / S
        found.append(gamma * max(abs(off_p) / S, turned, *np.abs(off / axes)))
    error = plain(error_estimate.local_error)
    step = SlipStep(swing, h, tuple(p), tuple(w))
    got = error(problem, frame, o, step, accuracy, motion)
    assert got == pytest.approx(max(found), rel=1e-6)


def test_a_slip_below_zero_is_infinitely_wrong():
    problem, frame, o, _, h = begin("steady", SLIDES[0], "not")
    step = SlipStep(plain(oscillation.swing)(o, h, False), h, (-frame.r,) * 3, (0.0,) * 3)
    assert plain(error_estimate.local_error)(problem, frame, o, step, ACCURACY, inf) == inf


def test_the_integral_of_the_unknown_products():
    """(M26) integrates p w, the slip across the step."""
    assert A.sum(axis=1) == pytest.approx(C)
