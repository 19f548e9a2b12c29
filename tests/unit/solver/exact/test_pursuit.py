"""The end of a slip in closed form, against the same equation in steps."""

from math import cos, hypot, inf, sin

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.entry import plain
from tests.systems import SLIDERS, motion_of, problem_of

import stiction as st
from stiction.solver.accuracy import Accuracy
from stiction.solver.exact import pursuit, slip_frame

F = 8.0
CASES = [(2e-3, 3.0, 1.0), (2e-3, -3.0, -4.0), (5.0, 0.5, 7.0), (2e-3, -5.0, 0.0), (1.0, 0.0, 0.0)]


def follow(r, a_1, a_2, until):
    """Return z and s at a time, of s' = a - f s/|s|."""

    def change(_, y):
        s = y[2:]
        return [*s, *(np.array([a_1, a_2]) - F * s / hypot(*s))]

    y = [0.0, 0.0, r, 0.0]
    return solve_ivp(change, (0.0, until), y, "DOP853", rtol=1e-12, atol=1e-15 * r).y[:, -1]


@pytest.mark.parametrize(("r", "a_1", "a_2"), CASES)
def test_time_and_distance_to_landing(r, a_1, a_2):
    """(M49), with the rest of a slip that a thousandth of the time is left of."""
    T = plain(pursuit.landing_time)(r, a_1, a_1**2 + a_2**2, F)
    z_1, z_2, *s = follow(r, a_1, a_2, 0.999 * T)
    assert hypot(*s) < 2e-3 * F / (F - hypot(a_1, a_2)) * r * F / (F - hypot(a_1, a_2))
    slid = plain(pursuit.landing_slip)(r, a_1, a_2, F)
    assert np.subtract(slid, (z_1, z_2)) == pytest.approx([0.0, 0.0], abs=1e-3 * T * hypot(*s))
    # what is left is a landing of its own, along its own slip
    e = np.array(s) / hypot(*s)
    a = a_1 * e[0] + a_2 * e[1], a_2 * e[0] - a_1 * e[1]
    rest = plain(pursuit.landing_slip)(hypot(*s), *a, F)
    z = [z_1 + rest[0] * e[0] - rest[1] * e[1], z_2 + rest[0] * e[1] + rest[1] * e[0]]
    assert slid == pytest.approx(z, abs=1e-9 * r * T)
    left = plain(pursuit.landing_time)(hypot(*s), a[0], a_1**2 + a_2**2, F)
    assert left == pytest.approx(1e-3 * T, rel=1e-8)


@pytest.mark.parametrize(("r", "a_1", "a_2"), CASES)
@pytest.mark.parametrize("part", [0.1, 0.6, 0.95])
def test_the_slip_before_a_landing(r, a_1, a_2, part):
    """r sin(alpha) tan(alpha/2)^(-f/|a|) is constant."""
    T = plain(pursuit.landing_time)(r, a_1, a_1**2 + a_2**2, F)
    _, _, *s = follow(r, a_1, a_2, part * T)
    speed, along, across = plain(pursuit.slip_before_landing)(r, a_1, a_2, F, (1 - part) * T)
    assert (speed * along, speed * across) == pytest.approx(s, abs=1e-8 * r)


@pytest.mark.parametrize(("r", "a_1", "a_2"), CASES)
@pytest.mark.parametrize("part", [0.1, 0.6])
def test_a_sample_before_a_landing(r, a_1, a_2, part):
    """The springs' elongation, the slip and the friction, each of the same equation in steps."""
    problem, motion = problem_of("steady"), motion_of(5e-4, 1e-5, 0.6 * r, 0.8 * r)
    T = plain(pursuit.landing_time)(r, a_1, a_1**2 + a_2**2, F)
    closed = T, *plain(pursuit.landing_slip)(r, a_1, a_2, F)
    samples, gone = np.zeros((1, 7)), part * T
    arguments = problem, motion, a_1, a_2, F, closed, T - gone, gone, samples, 0
    assert plain(pursuit.write_landing)(*arguments) == 1
    z_1, z_2, *s = follow(r, a_1, a_2, gone)
    along, across = np.array([0.6, 0.8]), np.array([-0.8, 0.6])
    c, sine = problem.system.cos_phi, problem.system.sin_phi
    driven = problem.drive.velocity * gone * np.array([c, sine])
    u = np.array([5e-4, 1e-5]) + driven - z_1 * along - z_2 * across
    assert samples[0, :2] == pytest.approx(u, abs=1e-8 * r * T)
    slip = s[0] * along + s[1] * across
    assert samples[0, 2:4] == pytest.approx(slip, abs=1e-8 * r)
    force = F * problem.system.mass * slip / hypot(*s)
    assert samples[0, 4:6] == pytest.approx(force, abs=1e-7 * F * problem.system.mass)
    assert samples[0, 6] == 0.0


def held_to(tolerance, speed):
    """Return an accuracy of which only this counts."""
    return Accuracy(tolerance, 0.0, speed, 0.0, 0.0, inf, inf, 1.0, 1e-2, 0.0, 0.0, 0.0)


def slow(name, angle=0.4, r=1e-9):
    """Return a slow slip that friction can end."""
    problem = problem_of(name)
    frame = plain(slip_frame.frame_of)(
        problem, motion_of(5e-4, 1e-5, r * cos(angle), r * sin(angle), 0.35)
    )
    return problem, frame, plain(slip_frame.outset)(problem, frame)


@pytest.mark.parametrize("name", ["steady", "program"])
def test_when_the_closed_form_ends_a_slip(name):
    """(M50): where a and f change by less than a tenth of tol sigma until then."""
    problem, frame, start = slow(name)
    T = plain(pursuit.landing_time)(frame.r, start.a_1, start.a_1**2 + start.a_2**2, start.f)
    load, t = problem.load, frame.t
    df = abs(load.drift(t)) / load.at(t) * start.f
    change = abs(start.da_1) + abs(start.da_2) + (frame.k_11 + frame.k_22) * frame.r + df
    change = T * (T * change + (abs(start.gradient) + frame.c_11 + frame.c_22) * frame.r)
    for part in (0.99, 1.01):
        accuracy = held_to(1e-3, 10 * change / 1e-3 * part)
        found = plain(pursuit.pursuit)(problem, frame, start, accuracy)
        if part > 1.0:
            slid = plain(pursuit.landing_slip)(frame.r, start.a_1, start.a_2, start.f)
            assert found == pytest.approx((T, *slid), rel=1e-12)
        else:
            assert found == (inf, 0.0, 0.0)


def test_how_much_the_springs_may_turn_a_slip_before_its_end():
    """(M50) without drive, damper or weakening: their force changes by (k_11 + k_22) r T."""
    problem = problem_of("steady")
    system = problem.system._replace(c_x=0.0, c_y=0.0)
    still = problem.drive._replace(velocity=0.0)
    problem = problem._replace(system=system, law=st.Coulomb(0.2), drive=still)
    r, a = 1e-3, np.array([0.0, 0.0])
    frame = plain(slip_frame.frame_of)(problem, motion_of(*a, 0.6 * r, 0.8 * r))
    start = plain(slip_frame.outset)(problem, frame)
    f = 0.2 * 10.0 / 0.25
    T = r / f
    change = T * T * (1e3 + 4e4) / 0.25 * r
    for part, closed in ((0.99, False), (1.01, True)):
        found = plain(pursuit.pursuit)(problem, frame, start, held_to(1e-3, 1e4 * change * part))
        assert found[0] == (pytest.approx(T) if closed else inf)


def test_a_slip_that_is_over_before_the_clock_sees_it_ends_in_closed_form():
    problem, frame, start = slow("steady")
    T = plain(pursuit.landing_time)(frame.r, start.a_1, start.a_1**2 + start.a_2**2, start.f)
    strict = held_to(1e-3, 1e-30)
    assert plain(pursuit.pursuit)(problem, frame, start, strict)[0] == inf
    for t in (-0.9e13 * T, 0.9e13 * T):  # the clock still sees it
        assert plain(pursuit.pursuit)(problem, frame._replace(t=t), start, strict)[0] == inf
    for t in (-1.1e13 * T, 1.1e13 * T):
        found = plain(pursuit.pursuit)(problem, frame._replace(t=t), start, strict)
        assert found[0] == pytest.approx(T)
    for shorter, seen in ((0.9e13 * T, True), (1.1e13 * T, False)):  # and so does the spring
        for squares in ((shorter**2, 1e99), (1e99, shorter**2)):
            held = strict._replace(square_x=squares[0], square_y=squares[1])
            found = plain(pursuit.pursuit)(problem, frame._replace(t=0.0), start, held)
            assert (found[0] == inf) == seen


@pytest.mark.parametrize("name", SLIDERS)
def test_what_friction_cannot_hold_or_is_elliptic_has_no_closed_form(name):
    problem, frame, start = slow(name)
    found = plain(pursuit.pursuit)(problem, frame, start, held_to(1.0, 1.0))
    assert (found[0] < inf) == problem.surface.isotropic()
    for a_1, ends in ((0.99 * start.f, True), (1.01 * start.f, False)):
        pulled = start._replace(a_1=a_1, a_2=0.0)
        found = plain(pursuit.pursuit)(problem, frame, pulled, held_to(1.0, 1.0))
        assert (found[0] < inf) == (ends and problem.surface.isotropic())
