"""The oscillation over which a step of slip is laid."""

from math import cos, exp, factorial, inf, pi, sin, sqrt

import numpy as np
import pytest
from scipy.linalg import expm
from tests.entry import plain
from tests.unit.solver.exact.test_collocation import begin
from tests.unit.solver.exact.test_newton import SLIDES, held_to

import stiction as st
from stiction.solver.exact.collocation import SlipStep
from stiction.solver.exact.error_estimate import dips
from stiction.solver.exact.oscillation import (
    CALM,
    MOST_SQUARE,
    STRONGEST,
    Oscillator,
    after,
    drift_of_level,
    oscillator,
    propagator,
    swing,
    within_reach,
)
from stiction.solver.exact.slip_frame import outset
from stiction.solver.stepping.radau import A, C, D, cubic

OSCILLATORS = [
    Oscillator(4e7, 1 / 4e7, -50.0, 1.7e-5, -0.01, -1e-5, 0.02),  # friction that weakens
    Oscillator(4e7, 1 / 4e7, 1e3, 1.7e-5, 0.02, 3e-5, -0.1),  # damped
    Oscillator(1.0, 1.0, 0.19, 0.0, 0.0, 1.0, 0.0),
]


_at, _cubic = plain(after), plain(cubic)


def _after(o, t):
    if np.ndim(t) == 0:
        return _at(o, t)
    return tuple(np.transpose([_at(o, each) for each in t]))


def _dips(o, h, p, margin):
    step = SlipStep(plain(swing)(o, h, False), h, p, (0.0, 0.0, 0.0))
    return plain(dips)(o, step, o.level + o.x, margin)


def _swing(o, h):
    return plain(swing)(o, h, True)


@pytest.mark.parametrize("o", OSCILLATORS)
@pytest.mark.parametrize("part", [0.1, 0.5, 1.0])
def test_it_solves_its_equation(o, part):
    """(M21) for p, p' and the distance, by the exponential of the matrix; the force grows."""
    t = part * sqrt(0.99 * MOST_SQUARE / o.k)
    generator = np.zeros((5, 5))
    generator[0, 1] = generator[2, 0] = generator[3, 4] = 1.0
    generator[1] = [-o.k, -2 * o.beta, 0, o.k * o.drift, o.k * o.level + 2 * o.beta * o.drift]
    start = [o.level + o.x, o.drift + o.v, 0.0, 0.0, 1.0]
    p, v, slid, _, _ = expm(t * generator) @ start
    scale = abs(o.x) + abs(o.v) / sqrt(o.k) + abs(o.level) + abs(o.drift) * t
    got = np.array(_after(o, t)) / [scale, scale * sqrt(o.k), scale * t]
    want = np.array([p, v, slid]) / [scale, scale * sqrt(o.k), scale * t]
    assert got == pytest.approx(want, abs=1e-12)


@pytest.mark.parametrize("part", [0.25, 1.0])
def test_the_series_of_a_quarter_of_the_longest_step(part):
    """Of cosine and sine, to the first term that each leaves out; with a few roundings."""
    square = part * MOST_SQUARE / 16.0
    o, t = OSCILLATORS[2]._replace(beta=0.0), sqrt(square)
    found = plain(propagator)(o, t)
    rounding = 4 * np.finfo(float).eps
    assert found[0] == pytest.approx(cos(t), abs=square**7 / factorial(14) + 0.5 * rounding)
    assert found[1] == pytest.approx(sin(t), abs=t * square**7 / factorial(15) + 0.25 * rounding)
    damped = o._replace(beta=STRONGEST)
    decay = plain(propagator)(damped, t)[1] / plain(propagator)(o, t)[1]
    shorter = sin(sqrt(1.0 - STRONGEST**2) * t) / sqrt(1.0 - STRONGEST**2) / sin(t)
    assert decay == pytest.approx(
        exp(-STRONGEST * t) * shorter, abs=(STRONGEST * t) ** 9 / factorial(9) + rounding
    )


@pytest.mark.parametrize("least", [-1e-3, 1e-3])
@pytest.mark.parametrize("early", [0.3, 0.5, 0.7])
def test_a_dip_between_the_stages_is_seen(least, early):
    """Of the oscillation itself; of a cubic through its values both kinds look alike."""
    h = sqrt(0.98 * MOST_SQUARE)
    o = Oscillator(1.0, 1.0, 0.0, 1.0 + least, 0.0, -np.cos(early * h), -np.sin(early * h))
    p = tuple(_after(o, c * h)[0] for c in C)
    assert min(p) > 0.0
    x = np.linspace(0.0, 1.0, 1001)
    assert _after(o, x * h)[0].min() == pytest.approx(least, abs=1e-5)
    assert _dips(o, h, p, 0.0) == (least < 0.0)
    assert not _dips(o, h, p, least - 1e-5)
    assert _dips(o, h, p, least + 1e-5)
    seen = min(_cubic((o.level + o.x, *p), each) for each in x)
    assert abs(seen - least) > abs(least)


@pytest.mark.parametrize("least", [-1e-3, 1e-3])
def test_a_dip_before_another_fall_is_seen(least):
    """In a step too long to be laid over an oscillation: the slip is its cubic."""
    bottom = 0.3
    slip = np.polynomial.Polynomial([0.0, 0.0, 3.0, -4.0])(np.polynomial.Polynomial([-bottom, 1.0]))
    slip, h = slip + least, sqrt(2.0 * MOST_SQUARE)
    p = tuple(float(slip(c)) for c in C)
    assert min(p) > 0.0
    assert p[1] > p[2]
    o = Oscillator(1.0, 1.0, 0.0, 0.0, 0.3, slip(0.0), slip.deriv()(0.0) / h - 0.3)
    assert _dips(o, h, p, 0.0) == (least < 0.0)


@pytest.mark.parametrize("off", [-1e-3, 1e-3])
def test_a_dip_of_an_oscillation_before_another_fall_is_seen(off):
    """The slip is least behind the first stage, rises to the second, and falls by a cubic."""
    h, x = 2.4, np.linspace(0.0, 1.0, 2001)
    o = Oscillator(1.0, 1.0, 0.0, 1.0, 0.0, -cos(0.6), -sin(0.6))  # least after 0.6

    def slip(x):
        return _after(o, x * h)[0] - 1.2 * x**3

    p = tuple(float(slip(c)) for c in C)
    assert p[0] < p[1] > p[2]
    least = slip(x[x < C[1]]).min()
    assert C[0] < x[np.argmin(slip(x[x < C[1]]))] < C[1]
    assert _dips(o, h, p, least + off) == (off > 0.0)


@pytest.mark.parametrize("o", OSCILLATORS)
def test_what_it_adds_to_the_equations_is_what_its_cubic_leaves(o):
    h = 0.5 * sqrt(MOST_SQUARE / o.k)
    p, v, slid = np.array([_after(o, c * h) for c in C]).T
    s = _swing(o, h)
    scale = np.abs(p).max() + h * np.abs(v).max()
    assert s.p == pytest.approx(p, abs=1e-13 * scale)
    assert s.rest == pytest.approx(h * v - np.array(D) @ (p - o.level - o.x), abs=1e-12 * scale)
    assert s.slid == pytest.approx(slid / h - np.array(A) @ p, abs=1e-12 * scale)
    less, more = _swing(o, h * (1 - 1e-5)), _swing(o, h * (1 + 1e-5))
    by_h = (np.array(more.rest) - np.array(less.rest)) / (2e-5 * h)
    # by differences: rounding of 1e-12 over 1e-5
    assert s.rest_by_h == pytest.approx(by_h, abs=1e-6 * scale / h)
    by_h = ((1 + 1e-5) * np.array(more.slid) - (1 - 1e-5) * np.array(less.slid)) / 2e-5
    assert s.slid_by_h == pytest.approx(by_h, abs=1e-6 * scale)


def test_the_level_drifts_where_the_slip_turns_steadily():
    """Of a slip along a line, in axes that turn with it: p'' = -k (p - P - G t) at any time."""
    frame, start = turning()
    drift = plain(drift_of_level)(frame, start, 0.0)
    turn = (start.a_2 - start.turn) / frame.r
    assert frame.k_11 * drift == pytest.approx(start.f * turn**2 - frame.k_12 * frame.r * turn)
    o = plain(oscillator)(frame, start._replace(a_1=start.f + drift))
    assert o.drift == drift
    assert o.v == pytest.approx(0.0, abs=1e-14 * start.f)
    assert o.level + o.x == frame.r


@pytest.mark.parametrize("change", [0.4, 2.1, -1.0])
def test_a_slip_that_swings_follows_no_drift(change):
    """Where the drift leaves more than half of the slip's change."""
    frame, start = turning()
    drift = plain(drift_of_level)(frame, start, 0.0)
    swung = start._replace(a_1=start.f + change * drift)
    assert plain(drift_of_level)(frame, swung, 0.0) == 0.0
    assert plain(drift_of_level)(frame, start._replace(a_1=start.f + 1.9 * drift), 0.0) == drift


def test_nor_does_one_whose_oscillations_grow_or_at_take_off():
    frame, start = turning()
    drift = plain(drift_of_level)
    damping = (frame.c_22 + start.f / frame.r) * frame.k_22 / frame.k_11
    assert drift(frame, start, -0.49 * damping) != 0.0
    assert drift(frame, start, -0.51 * damping) == 0.0
    assert drift(frame._replace(r=0.0), start, 0.0) == 0.0


def turning():
    """Return a step's axes and outset, of a slip whose change is all by the drift."""
    problem, frame, _, _, _ = begin("steady", SLIDES[0], "not")
    start = plain(outset)(problem, frame)
    turn = (start.a_2 - start.turn) / frame.r
    drift = (start.f * turn * turn - frame.k_12 * frame.r * turn) / frame.k_11
    return frame, start._replace(a_1=start.f + drift)


def test_constant_friction_along_an_axis_is_exact_at_any_tolerance():
    """Nothing turns, so that a step has nothing to approximate; see any textbook for u_x."""
    omega, V, F = 10.0, 0.1, 3.0
    slider = st.Slider(
        mass=1.0,
        k_x=omega**2,
        k_y=omega**2,
        phi="0 deg",
        normal_load=10.0,
        friction=st.Coulomb(F / 10.0),
        drive=st.ConstantVelocity(V),
    )
    pulled = st.Initial(u_x=0.08, v_x=0.0, v_y=0.0)
    turn = 0.5 * 2 * pi / omega
    end = st.simulate(slider, turn, initial=pulled, rtol=1e-2).final
    # u'' = -omega^2 u + F/m as long as the slip V - u' is positive
    want = F / omega**2 + (0.08 - F / omega**2) * cos(omega * turn)
    assert end["u_x"].item() == pytest.approx(want, rel=1e-12)


@pytest.mark.parametrize(("x", "v"), [(1.0, 0.0), (0.0, 1.0), (0.6, -0.8)])
@pytest.mark.parametrize("motion", [inf, 1e-4])
@pytest.mark.parametrize(("drift", "square"), [(0.0, 0.99 * MOST_SQUARE), (7.0, CALM)])
def test_a_step_covers_a_part_of_an_oscillation_that_can_be_seen(x, v, motion, drift, square):
    """One of less than the tolerance, of the slip or of the slower motion, is none."""
    k, accuracy = 400.0, held_to(1e-3)._replace(tolerance=1e-3)
    reach, most = plain(within_reach), np.sqrt(square / k)
    for part, seen in ((0.99, False), (1.01, True)):
        level = 7e-3
        # its size, x^2 + v^2/k, over the tolerance times sigma + P + x or the motion
        scale = min(accuracy.speed + level, motion) * 1e-3 / (1.0 - 1e-3 * x * (motion == inf))
        o = Oscillator(k, 1 / k, 0.0, level, drift, part * scale * x, part * scale * v * 20.0)
        assert reach(o, 2 * most, accuracy, motion) == pytest.approx(most if seen else 2 * most)
        assert reach(o, 0.9 * most, accuracy, motion) == 0.9 * most
        damped = o._replace(beta=1.1 * STRONGEST * 20.0)
        assert reach(damped, 2 * most, accuracy, motion) == 2 * most
