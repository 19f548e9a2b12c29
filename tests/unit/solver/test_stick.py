"""The force at zero slip, the time for which friction can hold it, and the margin."""

from math import inf, sqrt

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq
from tests.entry import plain
from tests.systems import MOTIONS, SLIDERS, Printed, motion_of, problem_of

import stiction as st
from stiction.solver import stick
from stiction.solver.problem import Bends
from stiction.solver.stepping.radau import C

HELD = [(0.3 * u_x, 0.3 * u_y) for u_x, u_y, _, _ in MOTIONS]


def margin_of(name, t, u):
    """(M6), with N and f_s of the problem."""
    problem = problem_of(name)
    printed = Printed(problem, motion_of(*u, 1.0, 0.0, t))
    n = problem.surface
    a, N = printed.holding(t, np.array(u)), np.array([[n.xx, n.xy], [n.xy, n.yy]])
    f = problem.law.coefficient(0.0) * problem.load.at(t) / printed.m
    return a @ np.linalg.solve(N, a) - f * f


def elongation_after(name, t, u, dt):
    """(M5)."""
    printed = Printed(problem_of(name), motion_of(*u, 1.0, 0.0, t))
    return np.array(u) + printed.drive("travel", t, dt)


@pytest.mark.parametrize("name", SLIDERS)
@pytest.mark.parametrize("u", HELD)
def test_the_margin_and_its_rate_of_change(name, u):
    """(M6), the latter by differences."""
    problem, t, step = problem_of(name), 0.35, 1e-6
    excess, half, square = plain(stick.margin)(problem, t, *u)
    assert excess == pytest.approx(margin_of(name, t, u), rel=1e-12)
    before, after = (
        margin_of(name, t + dt, elongation_after(name, t, u, dt)) for dt in (-step, step)
    )
    assert 2 * half == pytest.approx((after - before) / (2 * step), rel=1e-4, abs=1e-7 * square)
    f = problem.law.coefficient(0.0) * problem.load.at(t) / problem.system.mass
    assert square == pytest.approx(f * f, rel=1e-14)


@pytest.mark.parametrize("name", SLIDERS)
@pytest.mark.parametrize("u", HELD)
def test_a_stick_lasts_until_the_margin_is_used_up(name, u):
    """(M7) in closed form, (M9) in steps; by a search for the first change of sign."""
    t = 0.35
    times = np.linspace(0.0, 0.4, 401)
    margins = [margin_of(name, t + dt, elongation_after(name, t, u, dt)) for dt in times]
    duration, ends = plain(stick.stick_duration)(problem_of(name), t, *u, inf)
    assert ends
    first = int(np.argmax(np.array(margins) > 0.0))
    if margins[0] > 0.0:
        assert duration == 0.0
    elif first > 0:
        wanted = brentq(
            lambda dt: margin_of(name, t + dt, elongation_after(name, t, u, dt)),
            *times[first - 1 : first + 1],
        )
        assert duration == pytest.approx(wanted, rel=1e-9)
    else:
        assert duration > times[-1]


@pytest.mark.parametrize("name", SLIDERS)
@pytest.mark.parametrize("u_x", [-4e-3, 4e-3])
def test_beyond_the_limit_nothing_sticks_wherever_the_drive_goes(name, u_x):
    """Not even where the drive lets the springs go."""
    problem = problem_of(name)
    excess, change, _ = plain(stick.margin)(problem, 0.35, u_x, 0.0)
    assert excess > 0.0
    if name in ("steady", "ellipse"):
        assert (change > 0.0) == (u_x > 0.0)
    assert plain(stick.stick_duration)(problem, 0.35, u_x, 0.0, inf) == (0.0, True)


@pytest.mark.parametrize("limit", [1.0, 64.0])
def test_a_stick_begins_at_the_limit_where_the_drive_lets_the_spring_go(limit):
    """It ends where the spring pulls as much the other way; here a margin of 1e-14 f^2 is zero."""
    problem = problem_of("steady")
    system = problem.system._replace(
        mass=1.0, per_mass=1.0, k_x=1.0, k_y=1.0, c_x=0.0, c_y=0.0, cos_phi=1.0, sin_phi=0.0
    )
    drive, load = problem.drive._replace(velocity=0.25), problem.load._replace(force=limit)
    problem = problem._replace(system=system, law=st.Coulomb(1.0), drive=drive, load=load)
    for beyond, duration in ((0.0, 8.0 * limit), (4e-15, 8.0 * limit), (6e-15, 0.0)):
        u_x = -limit * (1.0 + beyond)
        found = plain(stick.stick_duration)(problem, 0.0, u_x, 0.0, inf)
        assert found == (pytest.approx(duration), True)


def test_a_stick_under_a_program_is_over_where_its_margin_is_rounding():
    """1e-14 of f^2."""
    problem, t = problem_of("program"), 0.35
    duration, _ = plain(stick.stick_duration)(problem, t, 0.0, 0.0, inf)
    u_x, u_y = elongation_after("program", t, (0.0, 0.0), duration)
    excess, change, square = plain(stick.margin)(problem, t + duration, u_x, u_y)
    beside, *_ = plain(stick.margin)(problem, t + duration, (1.0 - 1e-6) * u_x, u_y)
    assert change > 0.0
    for part, over in ((0.5, True), (2.0, False)):
        less = 1e-6 * (part * 1e-14 * square + excess) / (excess - beside)
        found = plain(stick.stick_duration)(problem, t + duration, (1.0 - less) * u_x, u_y, inf)
        assert (found[0] == 0.0) == over


def test_a_stick_under_a_program_that_outlasts_the_segment():
    """It is then infinite; in closed form the caller looks at the end itself."""
    u, t = (0.0, 0.0), 0.35
    duration, _ = plain(stick.stick_duration)(problem_of("program"), t, *u, inf)
    assert 0.0 < duration < inf
    for share in (0.5, 0.999, 1.001):
        found = plain(stick.stick_duration)(problem_of("program"), t, *u, t + share * duration)
        assert found == ((inf, True) if share < 1.0 else (pytest.approx(duration), True))


@pytest.mark.parametrize("name", SLIDERS)
def test_friction_at_its_limit_holds_on_until_slip_would_show(name):
    """(M9a): until the mean of the margin, up to the first stage of a step, is its rounding."""
    t, problem = 0.35, problem_of(name)
    duration, _ = plain(stick.stick_duration)(problem, t, 0.0, 0.0, inf)
    end, u = t + duration, elongation_after(name, t, (0.0, 0.0), duration)
    excess, change, square = plain(stick.margin)(problem, end, *u)
    longest = (1e-14 * square - excess) / change / C[0]  # s; so short that the margin is a line
    for share, holds in ((0.99, True), (1.01, False)):
        assert plain(stick.holds_on)(problem, end, *u, end + share * longest) == holds


@pytest.mark.parametrize("name", ["steady", "ellipse"])
def test_friction_that_holds_on_with_a_margin_that_is_a_parabola(name):
    """(M9a), by the integral of the margin from the middle of a stick on."""
    t, problem = 0.35, problem_of(name)
    duration, _ = plain(stick.stick_duration)(problem, t, 0.0, 0.0, inf)
    u = elongation_after(name, t, (0.0, 0.0), 0.5 * duration)

    def total(x):
        return quad(lambda dt: margin_of(name, t + dt, elongation_after(name, t, u, dt)), 0.0, x)[0]

    longest = brentq(total, 0.5 * duration, 2.0 * duration) / C[0]
    for share, holds in ((0.999, True), (1.001, False)):
        assert plain(stick.holds_on)(problem, t, *u, t + share * longest) == holds


@pytest.mark.parametrize(("over", "nearly"), [(1e-10, True), (1e-8, False), (1e-2, False)])
@pytest.mark.parametrize("name", ["steady", "ellipse"])
def test_a_margin_that_falls_holds_if_nearly_used_up_and_until_its_next_rise(name, over, nearly):
    """As where the drive turned: friction is over its limit now, and far over it once more."""
    t, problem = 0.35, problem_of(name)
    duration, _ = plain(stick.stick_duration)(problem, t, 0.0, 0.0, inf)
    at_limit = elongation_after(name, t, (0.0, 0.0), duration)
    limit = brentq(lambda f: margin_of(name, t, -f * np.array(at_limit)), 0.9, 1.5, xtol=1e-15)
    u = tuple(-(limit + over) * each for each in at_limit)
    excess, change, square = plain(stick.margin)(problem, t, *u)
    assert excess > 1e-14 * square
    assert change < 0.0

    def after(dt):
        return margin_of(name, t + dt, elongation_after(name, t, u, dt))

    again = brentq(after, duration, 3.0 * duration)
    for share, holds in ((0.5, True), (0.999, True), (1.001, False), (1.5, False), (3.0, False)):
        found = plain(stick.holds_on)(problem, t, *u, t + share * again)
        assert found == (holds and nearly)


@pytest.mark.parametrize("name", ["steady", "ellipse"])
def test_what_a_short_stick_has_to_spare(name):
    """(M10): the integral of f_s - |a|, to the share of the margin in f_s^2."""
    problem, t = problem_of(name), 0.35
    # a little before the end of a stick
    duration, _ = plain(stick.stick_duration)(problem, t, 0.0, 0.0, inf)
    u = elongation_after(name, t, (0.0, 0.0), 0.999 * duration)
    left, _ = plain(stick.stick_duration)(problem, t, *u, inf)
    f = problem.law.coefficient(0.0) * problem.load.at(t) / problem.system.mass

    def spare(dt):
        return f - sqrt(margin_of(name, t + dt, elongation_after(name, t, u, dt)) + f * f)

    wanted, _ = quad(spare, 0.0, left)
    assert plain(stick.to_spare)(problem, t, *u, left) == pytest.approx(wanted, rel=1e-2)


def test_bounds_of_the_margin_from_row_to_row():
    """Before the first row and behind the last, those beside them."""
    bends = Bends(np.array([1.0, 2.0, 4.0]), np.array([5.0, 6.0]))
    for t, bound, until in ((0.5, 5, 1), (1.0, 5, 2), (1.9, 5, 2), (2.0, 6, 4), (4.0, 6, 9)):
        assert (bends.bend_after(t), bends.smooth_until(t, 9.0)) == (bound, until)
    assert bends.smooth_until(2.0, 3.0) == 3.0


@pytest.mark.parametrize(
    ("constant", "linear", "quadratic"),
    [
        (-3.0, 2.0, 5.0),
        (-3.0, -2.0, 5.0),
        (-3.0, 0.0, 5.0),
        (-1e-12, 2.0, 5.0),
        (0.0, -2.0, 5.0),
        (-1e-12, -0.5, 5.0),
    ],
)
def test_the_positive_root(constant, linear, quadratic):
    """(M7), without cancellation."""
    found = plain(stick.used_up)(constant, linear, quadratic)
    roots = np.roots([quadratic, 2 * linear, constant])
    assert found == pytest.approx(roots.max(), rel=1e-12)


def test_the_root_of_a_line():
    assert plain(stick.used_up)(-3.0, 2.0, 0.0) == 0.75
    assert plain(stick.used_up)(-3.0, 0.5, 0.0) == 3.0
    assert plain(stick.used_up)(-3.0, 0.0, 0.0) == inf
    assert plain(stick.used_up)(-3.0, -2.0, 0.0) == inf
