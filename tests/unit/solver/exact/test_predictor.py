"""The time to landing, and first guesses of the stages."""

from math import inf

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from tests.entry import plain
from tests.systems import SLIDERS, motion_of, problem_of
from tests.unit.solver.exact.test_collocation import begin
from tests.unit.solver.exact.test_newton import SLIDES, held_to

from stiction.solver.exact import newton, oscillation, predictor, slip_frame
from stiction.solver.exact.collocation import SlipStep
from stiction.solver.state import Memory
from stiction.solver.stepping.limit import NO_LIMIT
from stiction.solver.stepping.radau import A, C, D
from stiction.solver.stick import margin, stick_duration

NODES = np.array([0.0, *C])
NOTHING = (0.0, 0.0, 0.0, 0.0)
COLD = Memory(1e-3, (0.0,) * 8, 0, 1e-3, 1.0, False, NOTHING, NOTHING, NO_LIMIT)
ALL = pytest.mark.parametrize(("name", "drawn"), [(n, d) for n in SLIDERS for d in SLIDES])


def outset_of(name, drawn, part="not"):
    problem, frame, o, _, h = begin(name, drawn, part)
    return problem, frame, plain(slip_frame.outset)(problem, frame), o, h


@pytest.mark.parametrize("change", [-3.0, -0.1, 0.1, 3.0, -1e-3])
@pytest.mark.parametrize("curve", [-50.0, 50.0, 0.0, 1.0])
def test_when_a_parabola_falls_to_zero(change, curve):
    """(M47): the first positive root of r + p' t + p'' t^2/2, if there is one."""
    _, frame, start, _, _ = outset_of("steady", SLIDES[0])
    bend = curve + frame.k_11 * frame.r
    start = start._replace(a_1=start.f + change, da_1=bend)
    roots = np.roots([0.5 * (bend - frame.k_11 * frame.r), change, frame.r])
    positive = [root.real for root in roots if root.real > 0.0 and abs(root.imag) < 1e-12]
    found = plain(predictor.landing_of_parabola)(frame, start)
    assert found == pytest.approx(min(positive, default=inf), rel=1e-9)


@pytest.mark.parametrize("off", [-0.1, 0.1])
def test_a_better_time_to_landing(off):
    """A step of Newton's method on the oscillation: the error is squared, and it is not halved."""
    o = oscillation.Oscillator(1.0, 1.0, 0.05, 0.3, 0.0, 1.0, -0.5)
    after = plain(oscillation.after)
    low, high = 0.1, 2.4
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if after(o, middle)[0] > 0.0 else (low, middle)
    found = plain(predictor.swung_to_rest)(o, low * (1 + off))
    assert abs(found / low - 1.0) < off * off
    rising = o._replace(x=1.0, v=0.5)
    assert plain(predictor.swung_to_rest)(rising, 0.1) == 0.1
    falling = o._replace(x=-0.29, v=-1.0)  # p/v would be before the start
    assert plain(predictor.swung_to_rest)(falling, 0.5) == 0.25
    assert plain(predictor.swung_to_rest)(o, 1e-3) == 1e-3  # no step is laid over it


def test_the_time_to_landing_is_close_if_it_is_within_reach():
    _, frame, start, o, _ = outset_of("steady", SLIDES[0])
    start = start._replace(a_1=start.f - 0.9 * frame.r * np.sqrt(frame.k_11))
    o = plain(oscillation.oscillator)(frame, start)
    parabola = plain(predictor.landing_of_parabola)(frame, start)
    closer = plain(predictor.swung_to_rest)(o, parabola)
    assert closer != parabola
    found = plain(predictor.time_to_landing)
    assert found(frame, start, o, parabola / 2.4) == closer
    assert found(frame, start, o, parabola / 2.6) == parabola


@pytest.mark.parametrize("u_x", [0.5e-3, 1.9e-3, 2.1e-3])
def test_a_slip_passes_by_zero_where_friction_cannot_hold(u_x):
    """M of (M6) at the end of the oscillation."""
    problem = problem_of("steady")
    frame = plain(slip_frame.frame_of)(problem, motion_of(u_x, 0.0, 1e-9, 3e-3))
    o = plain(oscillation.oscillator)(frame, plain(slip_frame.outset)(problem, frame))
    t = 1.0 / np.sqrt(frame.k_11)
    slid = plain(oscillation.after)(o, t)[2]
    u = plain(slip_frame.elongation)(problem, frame, t, slid, 0.0)
    excess = plain(margin)(problem, frame.t + t, *u)[0]
    assert plain(predictor.passes)(problem, frame, o, t) == (excess > 0.0)
    assert not plain(predictor.passes)(problem, frame, o, 1e-3 * t)  # not laid over it


def test_a_slip_that_goes_on_is_a_guess_by_its_cubics():
    """They are continued exactly; the turn from the last direction."""
    p, w = Polynomial([1e-3, 2e-4, -3e-4, 1e-4]), Polynomial([0.0, 0.1, 0.02, -0.03])
    _, frame, start, o, h = outset_of("steady", SLIDES[0])
    warm = COLD._replace(warm=True, h_last=2 * h, p=tuple(p(NODES)), w=tuple(w(NODES)))
    swing = plain(oscillation.swing)(o, h, False)
    guess = plain(predictor.predict)(frame, start, o, swing, h, warm)
    x = 1.0 + 0.5 * np.array(C)
    assert guess[0] == pytest.approx(p(x), rel=1e-12)
    assert guess[1] == pytest.approx(w(x) - w(1.0), rel=1e-11)


def test_a_slip_of_which_nothing_is_known_goes_on_in_a_line():
    """r + p' c h, but no lower than r (1 - c), and a tenth of r at the end."""
    _, frame, start, o, h = outset_of("steady", SLIDES[0])
    r, swing, c = frame.r, plain(oscillation.swing)(o, h, False), np.array(C)
    for change in (0.5 * r / h, -0.5 * r / h, -3.0 * r / h):
        pulled = start._replace(a_1=start.f + change)
        p, w = plain(predictor.predict)(frame, pulled, o, swing, h, COLD)
        least = [*(r * (1 - c[:2])), 0.1 * r]
        assert p == pytest.approx(np.maximum(r + change * c * h, least), rel=1e-12)
        assert w == (0.0, 0.0, 0.0)


def taken_off(name, static):
    """Return the axes at the end of a stick, friction having held `static` times as much."""
    undamped = problem_of(name).system._replace(c_x=0.0, c_y=0.0)
    slides = problem_of(name)._replace(system=undamped)
    problem = slides._replace(law=slides.law._replace(mu_0=slides.law.mu_0 * static))
    v = np.array([undamped.cos_phi, undamped.sin_phi]) * 2e-3
    u = np.array([0.0, 3e-5])
    t, _ = plain(stick_duration)(problem, 0.3, *u, inf)
    problem, u = slides, u + v * t
    force = np.array([problem.system.k_x, problem.system.k_y]) * u
    e = force / np.hypot(*force)
    frame = plain(slip_frame.frame_of)(
        problem, motion_of(*u, 1.0, 0.0)._replace(r=0.0, e_x=e[0], e_y=e[1])
    )
    return problem, frame, plain(slip_frame.outset)(problem, frame)


@pytest.mark.parametrize("static", [1.0, 1.5])
def test_a_take_off_is_guessed_along_its_branch(static):
    """(M19) without damping: the error of the guess goes to zero with the step size."""
    problem, frame, start = taken_off("steady", static)
    o, off = plain(oscillation.oscillator)(frame, start), []
    if static == 1.0:
        start = start._replace(a_1=start.f)  # or else rounding
    for h in (1e-6, 1e-7):
        s = plain(oscillation.swing)(o, h, False)
        p, w = plain(predictor.predict)(frame, start, o, s, h, COLD)
        accuracy = held_to(1e-12)._replace(speed=1e-30)
        guess = SlipStep(s, h, p, w)
        converged, found, _ = plain(newton.solve)(problem, frame, o, guess, False, accuracy, 1.0)
        assert converged
        off.append([np.divide(p, found.p) - 1.0, np.divide(w, found.w) - 1.0])
    assert np.abs(off[0]).max() < 0.05
    assert np.abs(off[1]).max() < 0.15 * np.abs(off[0]).max()


@ALL
def test_over_the_oscillation_the_guess_is_of_the_second_order(name, drawn):
    """What (M28) and (M29) leave of it falls with h^2."""
    problem, frame, start, o, h = outset_of(name, drawn, "laid over the oscillation")
    off = []
    for part in (0.1, 0.03):
        s = plain(oscillation.swing)(o, part * h, False)
        p, w = plain(predictor.predict)(frame, start, o, s, part * h, COLD)
        guess = SlipStep(s, part * h, p, w)
        _, (_, _, p_1, w_1), _ = plain(newton.solve)(
            problem, frame, o, guess, False, held_to(1e-13), 1.0
        )
        off.append([np.abs(np.subtract(p, p_1)).max() / frame.r, np.abs(np.subtract(w, w_1)).max()])
    assert np.max(off[0]) < 4e-3
    assert (np.array(off[1]) < 0.25 * np.array(off[0])).all()


@ALL
def test_the_guess_over_the_oscillation_solves_the_turn_s_linear_equation(name, drawn):
    """(M29) without w^2 and on no ellipse, for the oscillation's p; then its effect on p, once."""
    _, frame, start, o, h = outset_of(name, drawn, "laid over the oscillation")
    s = plain(oscillation.swing)(o, h, False)
    found, w = map(np.array, plain(predictor.predict_by_oscillation)(frame, start, o, s, h))
    (a, c, d), p = (np.array(each) for each in (A, C, D)), np.array(s.p)
    k_12, k_22 = frame.k_12, frame.k_22
    pull = start.a_2 - start.turn + c * h * start.da_2 - h * k_12 * (a @ p + s.slid)
    matrix = np.diag(p) @ d + h * h * k_22 * a @ np.diag(p) + np.diag(h * start.f + s.dp)
    assert w == pytest.approx(np.linalg.solve(matrix, h * pull), rel=1e-9)
    known = 0.5 * o.k * o.drift * (c * h) ** 2
    more = h * a @ (0.5 * start.f * w * w - h * k_12 * a @ (p * w) - known)
    assert found - p == pytest.approx(more, rel=1e-6, abs=1e-15)
    plainly = plain(predictor.predict)(frame, start, o, s, h, COLD)
    assert np.array(plainly) == pytest.approx(np.array([found, w]))
