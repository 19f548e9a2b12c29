"""Inside a step: the polynomials, the balance of the equations there, and the error of the step."""

from math import hypot, inf

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.integrate import solve_ivp
from tests.drawn import inside
from tests.entry import plain
from tests.unit.solver.smooth.systems import (
    EXACT,
    LAWS,
    MOTION,
    STATELESS,
    A,
    C,
    Equations,
    at_stages,
    begun,
)

from stiction.solver.smooth import error_estimate, newton
from stiction.solver.smooth.newton import CLOSEST
from stiction.solver.smooth.workspace import INSIDE, START, workspace
from stiction.solver.stepping.radau import DEFECT_WEIGHT, INTERIOR

NODES = np.array([0.0, *C])
NONE = (0.0, 0.0)
ROW = np.array(inside(3, *[(-1.0, 1.0)] * 12)[0])
PI = Polynomial.fromroots(C)


@pytest.mark.parametrize("c", [0.2, 0.4, 1.0])
def test_the_polynomials_inside_a_step_and_their_error(c):
    """Value, derivative and integral; the error goes as Pi(c)/|Pi(c_1)|, but for the distance."""
    w = plain(workspace)(1)
    x, y, z = (Polynomial(ROW[4 * i : 4 * i + 4]) for i in range(3))
    w.values[:4] = np.transpose([each(NODES) for each in (x, y, z)])
    found = plain(error_estimate.within)(w, c)
    quadratics = [Polynomial.fit(C, each(C), 2, domain=[-1, 1]).convert() for each in (x, y)]
    slid = [each.integ()(c) for each in quadratics]
    wanted = x(c), y(c), x.deriv()(c), y.deriv()(c), *slid
    assert found == pytest.approx(wanted, abs=1e-12)
    assert w.cubic[:, 2] == pytest.approx([z(c), z.deriv()(c)], abs=1e-12)
    w.error[:] = 0.3, -0.2, 0.7
    shape = PI.integ() / abs(PI.integ()(C[0]))
    less = plain(error_estimate.less_error)(w, found, c)
    off = *(w.error[:2] * shape(c)), *(w.error[:2] * shape.deriv()(c)), 0.0, 0.0
    assert less == pytest.approx(np.array(wanted) - off, abs=1e-12)
    assert w.cubic[:, 2] == pytest.approx(
        [z(c) - 0.7 * shape(c), z.deriv()(c) - 0.7 * shape.deriv()(c)], abs=1e-12
    )


def solved_step(name, h, drive="program"):
    """Return a problem, and a step of it with its stages."""
    problem, start, w, (q_x, q_y) = begun(name, drive)
    w.values[1:4] = w.values[START]
    found, _ = plain(newton.solve)(problem, start, h, (q_x,) * 3, (q_y,) * 3, w, EXACT)
    assert found
    return problem, start, w


def fit(x, y):
    return Polynomial.fit(x, y, len(x) - 1, domain=[-1, 1]).convert()


def polynomials(w, c):
    """Return the cubic of slip and states at c, its derivative, and the distance slid over h."""
    cubic = [
        Polynomial.fit(NODES, column, 3, domain=[-1, 1]).convert() for column in w.values[:4].T
    ]
    slid = [Polynomial.fit(C, w.values[1:4, i], 2, domain=[-1, 1]).convert() for i in (0, 1)]
    return (
        np.array([each(c) for each in cubic]),
        np.array([each.deriv()(c) for each in cubic]),
        np.array([each.integ()(c) for each in slid]),
    )


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("drive", ["steady", "spring"])
@pytest.mark.parametrize(("c", "weight"), [(INTERIOR, DEFECT_WEIGHT), (0.8, 0.8)])
@pytest.mark.parametrize("h", [1e-4, 3e-3])
def test_a_balance_inside_a_step(name, drive, c, weight, h):
    """(M70): y - P + weight (P_c - h f(y)) = 0."""
    problem, start, w = solved_step(name, h, drive)
    p = plain(error_estimate.within)(w, c)
    balanced = plain(error_estimate.balance)(problem, start, h, c, weight, p, w, 1e-20, NONE)
    assert balanced.found
    value, by_c, slid = polynomials(w, c)
    s, z = np.array(balanced.slip), w.values[INSIDE, 2:]
    a, dz = Equations(name, drive).rates(c * h, h * slid, s, z)
    off = np.array([*s, *z]) - value + weight * (by_c - h * np.array([*a, *dz]))
    scale = [hypot(*MOTION[2:])] * 2 + list(w.size[2:])
    assert np.abs(off / scale).max() < 1e-10
    assert np.abs(value - [*s, *z]).max() > 0.0  # it is not the polynomial itself


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("h", [1e-4, 3e-3])
def test_the_error_of_a_step(name, h):
    """P - y at c = 0.4 over what it is held against; the largest counts, as does slow motion."""
    problem, start, w = solved_step(name, h)
    start = start._replace(share=0.25)
    error = plain(error_estimate.local_error)(problem, start, h, w, EXACT)
    value, _, _ = polynomials(w, INTERIOR)
    p = plain(error_estimate.within)(w, INTERIOR)
    of = problem, start, h, INTERIOR, DEFECT_WEIGHT
    farther = plain(error_estimate.distance_error)(w)
    s = np.array(plain(error_estimate.balance)(*of, p, w, 1e-20, NONE).slip)
    z = w.values[INSIDE, 2:].copy()
    off = value - [*s, *z]
    p = p._replace(slid_x=p.slid_x + farther[0], slid_y=p.slid_y + farther[1])
    other = plain(error_estimate.balance)(*of, p, w, 1e-20, NONE).slip  # (M70b)
    slip = max(hypot(*off[:2]), hypot(*(value[:2] - other[:2])))
    parts = [slip / (EXACT.speed + hypot(*s)), *np.abs(off[2:] / w.size[2:])]
    # one iteration with a fresh Jacobian, or two: its error is quadratic in the correction
    assert error == pytest.approx(max(parts) / 0.25, rel=1e-2)
    assert w.error == pytest.approx(off, rel=5e-2, abs=1e-2 * max(parts) * w.size.min())


@pytest.mark.parametrize("h", [1e-5, 3e-4])
def test_a_balance_farther_along(h):
    """By so much slower is the slip for a little more distance slid."""
    for name in STATELESS:  # states, which feel the slip, are left as they are
        problem, start, w = solved_step(name, h, "steady")
        of = problem, start, h, INTERIOR, DEFECT_WEIGHT
        p = plain(error_estimate.within)(w, INTERIOR)
        _, slip, slower, _ = plain(error_estimate.balance)(*of, p, w, 1e-20, (3e-9, -2e-9))
        p = p._replace(slid_x=p.slid_x + 3e-9, slid_y=p.slid_y - 2e-9)
        other = plain(error_estimate.balance)(*of, p, w, 1e-20, NONE).slip
        assert (slip[0] - other[0], slip[1] - other[1]) == pytest.approx(slower, rel=1e-2)


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("h", [1e-5, 1e-3])
def test_the_slip_that_rounding_makes(name, h):
    """That of springs longer by some roundings, along either axis or both (M70c)."""
    problem, start, w = solved_step(name, h, "steady")
    balance, of = plain(error_estimate.balance), (h, INTERIOR, DEFECT_WEIGHT)
    p = plain(error_estimate.within)(w, INTERIOR)
    known = balance(problem, start, *of, p, w, 1e-20, NONE)
    share, moved = 1e-7, []
    for x, y in ((1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, -1.0)):
        longer = start._replace(
            u_x=start.u_x * (1.0 + share * x), u_y=start.u_y * (1.0 + share * y)
        )
        slip = balance(problem, longer, *of, p, w, 1e-20, NONE).slip
        moved.append(hypot(slip[0] - known.slip[0], slip[1] - known.slip[1]))
    assert 0.3 < max(moved) / (known.rounding * share / CLOSEST) < 1.01


def test_the_middle_does_not_see_the_distance_and_reverses_the_error_of_slip():
    """(M70b): Pi(0.4) = 0, and gamma pi(0.4) = -Pi(c_1)."""
    assert PI.integ()(INTERIOR) == pytest.approx(0.0, abs=1e-16)
    assert DEFECT_WEIGHT * PI(INTERIOR) == pytest.approx(-PI.integ()(C[0]))


def test_the_error_of_the_distance_slid():
    """It is the integral of the quadratic less that of the cubic, at the first stage (M70b)."""
    _, _, w = solved_step("smoothed", 1e-3)
    cubics = [fit(NODES, w.values[:4, i]) for i in (0, 1)]
    quadratics = [fit(C, w.values[1:4, i]) for i in (0, 1)]
    off = [(b - a).integ()(C[0]) for a, b in zip(cubics, quadratics, strict=True)]
    assert plain(error_estimate.distance_error)(w) == pytest.approx(off)


@pytest.mark.parametrize("name", STATELESS)
def test_errors_of_slip_and_distance_add_up_as_they_do_at_the_first_stage(name):
    """Both have the sign of the error there, reversed, where slip follows the springs."""
    h = 1e-2
    problem, start, w = solved_step(name, h, "steady")
    equations = Equations(name, "steady")

    def rates(dt, motion):
        return [*equations.rates(dt, motion[2:], motion[:2], np.zeros(0))[0], *motion[:2]]

    begin = [*w.values[START, :2], 0.0, 0.0]
    right = solve_ivp(rates, (0.0, h * C[0]), begin, method="Radau", rtol=1e-10, atol=1e-15)
    error = w.values[1, :2] - right.y[:2, -1]
    p, farther = plain(error_estimate.within)(w, INTERIOR), plain(error_estimate.distance_error)(w)
    of = problem, start, h, INTERIOR, DEFECT_WEIGHT
    _, slip, slower, _ = plain(error_estimate.balance)(*of, p, w, 1e-20, farther)
    seen, slower = np.array([p.s_x, p.s_y]) - slip, np.array(slower)
    off, other = (np.hypot(*(seen + sign * slower + error)) for sign in (1.0, -1.0))
    assert off < 0.6 * other
    assert off < 0.8 * np.hypot(*error)


def test_the_error_falls_with_the_fourth_power_of_the_step():
    """The cubic is wrong by pi(c) h^4 times a derivative, (M36)."""
    for name in ("smoothed", "lugre"):
        errors = []
        for h in (4e-5, 2e-5):
            problem, start, w = solved_step(name, h, "steady")
            errors.append(plain(error_estimate.local_error)(problem, start, h, w, EXACT))
        assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.3)


@pytest.mark.parametrize("name", ["ageing", "slip"])
@pytest.mark.parametrize("h", [1e-4, 1e-3, 1e-2])
def test_a_balance_over_many_decades_takes_few_iterations(name, h, monkeypatch):
    """From 1e-15 m/s on, since updates are damped by the share of inertia (M69)."""
    problem, start, w, _ = begun(name, "steady", motion=(3e-3, 1e-6, 1e-15, -2e-16))
    w.values[1:4] = w.values[START]
    balance, points = plain(error_estimate.balance), []
    evaluate = balance.__globals__["evaluate"]

    def noted(*arguments):
        points.append(evaluate(*arguments))
        return points[-1]

    monkeypatch.setitem(balance.__globals__, "evaluate", noted)
    p = plain(error_estimate.within)(w, INTERIOR)
    balanced = balance(problem, start, h, INTERIOR, DEFECT_WEIGHT, p, w, 1e-12, NONE)
    assert balanced.found
    assert balanced.slip[0] > 0.5 * h
    assert len(points) <= 6  # without the damping 8 to 10


def test_the_share_of_inertia_has_both_mixed_derivatives_of_friction(monkeypatch):
    """They differ where friction depends on the direction of slip, as here they are made to."""
    problem, start, w = solved_step("ageing", 1e-4)
    balance, points, frictions = plain(error_estimate.balance), [], []
    evaluate, inertia_share = (balance.__globals__[x] for x in ("evaluate", "inertia_share"))

    def noted(*arguments):
        at = evaluate(*arguments)
        points.append(at._replace(f_yx=at.f_yx + 0.1 * at.f_xx))
        return points[-1]

    def note_share(*arguments):
        frictions.append(arguments[-1])
        return inertia_share(*arguments)

    monkeypatch.setitem(balance.__globals__, "evaluate", noted)
    monkeypatch.setitem(balance.__globals__, "inertia_share", note_share)
    p = plain(error_estimate.within)(w, INTERIOR)
    balance(problem, start, 1e-4, INTERIOR, DEFECT_WEIGHT, p, w, 1e-12, NONE)
    (xx, mixed, yy), at = frictions[0], points[0]
    assert (xx, yy) == (at.f_xx, at.f_yy)
    assert mixed == pytest.approx(0.5 * (at.f_xy + at.f_yx), rel=1e-12)


@pytest.mark.parametrize("name", ["smoothed", "lugre", "ageing"])
def test_without_a_balance_the_error_is_infinite(name):
    problem, start, w = solved_step(name, 1e-3)
    w.values[2, 0] = np.nan
    assert plain(error_estimate.local_error)(problem, start, 1e-3, w, EXACT) == inf
    problem, start, w = solved_step(name, 1e-3)
    p = plain(error_estimate.within)(w, 0.5)
    balanced = plain(error_estimate.balance)(problem, start, 1e-3, 0.5, 0.5, p, w, 0.0, NONE)
    assert balanced.found == (start.eps == inf)  # nothing is exact enough but rounding


def test_the_distance_slid_is_that_of_the_stages():
    """At the end of a step it is the last row of A."""
    _, _, w = solved_step("lugre", 1e-3)
    s, _ = at_stages(w)
    p = plain(error_estimate.within)(w, 1.0)
    assert (p.slid_x, p.slid_y) == pytest.approx(A[2] @ s)
