"""The equations of ``docs/method.md``, one by one, against the compiled solver.

Those of a step of slip are written down once more in `tests.rebuild`. Steps are the solver's own:
one turn of its loop at a time, whose stages it remembers.
"""

import importlib
import re
from functools import cache
from math import acos, asinh, atan, atan2, cos, exp, hypot, inf, log, pi, sin, sqrt, tan
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.optimize import brentq, root
from tests.entry import plain
from tests.rebuilt.run import Solver
from tests.rebuilt.step import PI, A, C, D, Step, gamma

import stiction as st
import stiction.solver
from stiction.solver.accuracy import accuracy, scales_of, tolerance
from stiction.solver.compilation.jit import call_compiled
from stiction.solver.exact.loop import advance
from stiction.solver.exact.method import Exact
from stiction.solver.exact.pursuit import slip_before_landing
from stiction.solver.exact.record import record_of
from stiction.solver.problem import Elliptic, Isotropic, kinds_of
from stiction.solver.regularised import (
    Smoothed,
    SmoothedByArctan,
    friction_and_gradient,
)
from stiction.solver.segments import segments
from stiction.solver.smooth import loop as smooth_loop
from stiction.solver.smooth.coordinate import coordinate, damped_rise, slip_and_slope, slip_at
from stiction.solver.smooth.elimination import correct_states, residuals_without
from stiction.solver.smooth.method import Smooth
from stiction.solver.smooth.newton import factors, linear
from stiction.solver.smooth.right_hand_side import Stages
from stiction.solver.smooth.state import with_numbers
from stiction.solver.smooth.workspace import workspace
from stiction.solver.state import Motion, State, start, state_from_plain
from stiction.solver.stepping.block_algebra import solve_blocks
from stiction.solver.stick import stick_duration, to_spare
from stiction.solver.surface import takeoff

ROOT = Path(__file__).parents[3]
TEXT = (ROOT / "docs/method.md").read_text(encoding="utf-8")
TAGS = re.findall(r"\\tag\{M(\d+[a-z]?)\}", TEXT)
SOLVER = Path(stiction.solver.__file__).parent

coordinate, damped_rise, slip_and_slope, slip_at = map(
    plain, (coordinate, damped_rise, slip_and_slope, slip_at)
)
stick_duration, takeoff, to_spare = map(plain, (stick_duration, takeoff, to_spare))

SMOOTHED = numba.njit(lambda law, slip, load: friction_and_gradient(law, slip, load))

NEWTON = 1e-11  # what corrections are iterated to here, so that residuals vanish


# --- steps that the solver takes ----------------------------------------------------------------

PAPER = st.presets.nakano_popov_2020()
DAMPED = PAPER.replace(
    phi="5 deg", k_y="1 MN/m", c_x=3.0, c_y=20.0, drive=st.ConstantVelocity("2 mm/s")
)
STRONGLY_DAMPED = DAMPED.replace(c_x=20.0, c_y=500.0)
STATIC = DAMPED.replace(friction=st.Coulomb(mu_0=0.2, mu_static=0.25))
ELLIPSE = DAMPED.replace(
    friction=st.laws.Anisotropic(st.ExponentialWeakening(0.2, 0.1, "10 mm/s"), 1.4, "30 deg")
)
# the errors of these are held against the motion about steady sliding, and against the soft
# spring's rate while the other slips fast
SETTLING = STRONGLY_DAMPED.replace(phi="30 deg", drive=st.ConstantVelocity("50 mm/s"))
STIFF = PAPER.replace(
    k_x="100 MN/m", k_y="1 kN/m", phi="70 deg", c_x=50.0, drive=st.ConstantVelocity("20 mm/s")
)
SLIDERS = {
    "damped": DAMPED,
    "strongly damped": STRONGLY_DAMPED,
    "settling": SETTLING,
    "stiff": STIFF,
    "static coefficient": STATIC,
    "ellipse": ELLIPSE,
}


class Taken(NamedTuple):
    """A step of slip: the state before it, the motion at its start and its end, its stages.

    `error` is over the tolerance, and 0 where it is so small that the solver does not keep it.
    """

    state: State
    before: Motion
    after: Motion
    h: float
    p: np.ndarray
    w: np.ndarray
    error: float


def problem_of(slider, rtol=1e-6):
    """Return what the solver works on, and what a step is held to."""
    segment = next(segments(slider, 0.0, 1.0))
    held = accuracy(slider, scales_of(slider, st.Initial()), segment, 0.0, rtol)
    return segment.problem, held._replace(newton=NEWTON)


def turn(name, problem, held, state, times=()):
    """Let the loop turn once; return the state and the samples."""
    times, sticks = np.array(times, dtype=float), np.zeros((8, 2))
    samples = np.full((len(times), 7), np.nan)
    state = state._replace(counts=state.counts._replace(sticks=0, stuck=0.0))
    problem = Exact(SLIDERS[name]).point_law(problem)
    arguments = problem, state, 1e9, held, 1, times, samples, 0, sticks, record_of(0)
    _, after, _, _ = call_compiled(advance, kinds_of(problem), *arguments)
    return state_from_plain(after), samples


def rebuild(slider, motion):
    """Return the rebuilt solver in a state of motion."""
    run = Solver(slider, 1e-6)
    run.t, run.u, run.r = motion.t, np.array([motion.u_x, motion.u_y]), motion.r
    run.e = np.array([motion.e_x, motion.e_y])
    return run


def end_of_stick(slider, motion):
    """Return the motion at the end of a stick, by (M5) to (M7) and (M18)."""
    run = rebuild(slider, motion)
    run.stick(inf)
    return Motion(run.t, *run.u, 0.0, *run.e)


@cache
def walk(name):
    """Return what the solver works on, and the steps of slip that a run takes from a stick on."""
    problem, held = problem_of(SLIDERS[name])
    state, found = start(SLIDERS[name], 0.0, (0.0, 0.0), (0.0, 0.0)), []
    for _ in range(50):
        before = state.motion
        if before.r == 0.0:
            before = end_of_stick(SLIDERS[name], before)
        after, _ = turn(name, problem, held, state)
        m = after.memory
        if after.counts.steps > state.counts.steps:
            error = m.ease**-4 - 1e-10 if m.ease < 3.0 else 0.0
            stages = np.array(m.p[1:]), np.array(m.w[1:])
            found.append(Taken(state, before, after.motion, m.h_last, *stages, error))
        state = after
    return problem, held, found


def equations_of(name, step):
    """Return the equations of a step that the solver has taken."""
    return Step(rebuild(SLIDERS[name], step.before))


def test_the_steps_looked_at_are_of_all_kinds():
    """Take-offs, landings, laid over the oscillation or not, longer than it."""
    seen = set()
    for name in SLIDERS:
        for step in walk(name)[2]:
            seen |= equations_of(name, step).kinds(step.h) | (
                {"landing"} if step.p[2] == 0.0 else set()
            )
    assert seen == {"take-off", "slip", "landing", "long", "plain", "laid over"}


# --- sections 4 to 7 ----------------------------------------------------------------------------


@pytest.mark.parametrize("name", SLIDERS)
def test_the_printed_residuals_vanish(name):
    """Newton's error is 1e-11 of p and of w, and D is 8 at most."""
    for step in walk(name)[2]:
        each = equations_of(name, step)
        found, _ = each.equations(step.h, step.p, step.w)
        forces = step.h * np.abs(each.accelerations(step.h, step.p, step.w)).max()
        terms = forces + np.abs(D).max() * max(step.before.r, step.p.max())
        assert np.abs(found).max() < 10 * NEWTON * terms


@pytest.mark.parametrize("name", ["damped", "ellipse"])
def test_the_printed_jacobian_is_the_derivative_of_the_residuals(name):
    """(M31) and (M44) to (M46); of differences about a step that is laid over the oscillation."""
    for step in walk(name)[2][4:8]:
        equations, h = equations_of(name, step).equations, step.h
        x = np.concatenate([step.p + 1e-3 * step.p.max(), step.w])
        scale = np.repeat([step.p.max(), 1e-2], 3)

        def residuals(x, h=h, equations=equations):
            return equations(h, *x.reshape(2, 3))[0]

        found = equations(h, *x.reshape(2, 3))[1] * scale
        columns = [(residuals(x + d) - residuals(x - d)) / 2e-5 for d in 1e-5 * np.diag(scale)]
        assert found == pytest.approx(np.transpose(columns), abs=1e-7 * np.abs(found).max())
        more, less = residuals(x, h * (1 + 1e-5)), residuals(x, h * (1 - 1e-5))
        found = h * equations(h, *x.reshape(2, 3), landing=True)[1][:, 2]
        assert found == pytest.approx((more - less) / 2e-5, abs=1e-7 * np.abs(found).max())


@pytest.mark.parametrize("name", SLIDERS)
def test_the_printed_end_of_a_step_is_the_solver_s(name):
    for step in walk(name)[2]:
        u, r, e = equations_of(name, step).end(step.h, step.p, step.w)
        after = step.after
        assert after.t == pytest.approx(step.before.t + step.h, rel=1e-14)
        assert (after.u_x, after.u_y) == pytest.approx(u, rel=1e-11)
        assert after.r == pytest.approx(r, rel=1e-12)
        assert (after.e_x, after.e_y) == pytest.approx(e, abs=1e-12)


@pytest.mark.parametrize("w", [-0.7, 0.0, 0.3])
def test_the_friction_along_and_across_is_that_of_the_ellipse(w):
    """(M12) is N s/|M s| in the step's axes, (M16) its derivative."""
    n = problem_of(ELLIPSE)[0].surface
    each = Step(rebuild(ELLIPSE, Motion(0.0, 0.0, 0.0, 1.0, 0.6, 0.8)))
    N, s = np.array([[n.xx, n.xy], [n.xy, n.yy]]), each.e + w * each.n
    force = N @ s / sqrt(s @ N @ s)
    _, _, *found = each.friction(1.0, w)
    (n_1, _), (tau, _) = found
    assert (n_1, tau + w * n_1) == pytest.approx((force @ each.e, force @ each.n), rel=1e-13)
    step = 1e-5  # differences: 1e-10, and rounding of 1e-11
    sides = zip(
        found, each.friction(1.0, w + step)[2:], each.friction(1.0, w - step)[2:], strict=True
    )
    for (_, change), (more, _), (less, _) in sides:
        assert change == pytest.approx((more - less) / (2 * step), rel=1e-8, abs=1e-10)


@pytest.mark.parametrize("slider", [DAMPED, ELLIPSE], ids=["isotropic", "ellipse"])
def test_the_equations_of_motion(slider):
    """(M1) to (M4), of a run's own samples; accelerations by differences, between sticks."""
    run = st.simulate(slider, 0.05, sample_rate=1e6, rtol=1e-9)
    data, solver = {name: each.to_numpy() for name, each in run.data.items()}, Solver(slider, 1e-9)
    s = np.array([data["slip_x"], data["slip_y"]])
    rate = np.array([data["v_x"], data["v_y"]])
    assert s + rate == pytest.approx(np.outer(solver.v_d, np.ones(s.shape[1])), abs=1e-12)
    sliding = np.flatnonzero((data["slip_speed"] > 1e-4) & (data["sticking"] == 0))
    assert len(sliding) > 1000
    inside = sliding[np.isin(sliding - 1, sliding) & np.isin(sliding + 1, sliding)]
    flow = solver.N @ s
    mu = np.array([solver.law.coefficient(v) for v in data["slip_speed"]])
    with np.errstate(invalid="ignore"):
        phi = mu * solver.per_mass * flow / np.sqrt(np.sum(s * flow, axis=0))
    u = np.array([data["u_x"], data["u_y"]])
    a = solver.K[:, None] * u + solver.C[:, None] * rate
    change = (s[:, inside + 1] - s[:, inside - 1]) / 2e-6
    terms = np.abs(a[:, inside]).max()
    assert change == pytest.approx((a - phi)[:, inside], abs=1e-3 * terms)
    size = np.hypot(*phi[:, inside]) * solver.mass
    assert data["friction"][inside] == pytest.approx(size, rel=1e-9)
    held = np.flatnonzero(data["sticking"] == 1)
    squares = [a[:, k] @ np.linalg.solve(solver.N, a[:, k]) for k in held]
    assert max(squares) <= solver.f_s**2 * (1 + 1e-9)


@pytest.mark.parametrize("slider", [DAMPED, ELLIPSE], ids=["isotropic", "ellipse"])
def test_the_p_w_form_is_newton_s_law(slider):
    """(M11), (M13) and (M14) give the vector equation (M2)."""
    each = Step(rebuild(slider, Motion(0.0, 1e-3, 2e-6, 1e-3, 0.6, 0.8)))
    for p, w in ((1e-3, 0.0), (2e-3, 0.4), (3e-4, -1.3)):
        a = each.b - each.c @ [p, p * w]
        f, _, (n_1, _), (tau, _) = each.friction(p, w)
        dp, p_dw = a[0] - f * n_1, a[1] - w * a[0] - f * tau
        s, N = np.array([p, p * w]), each.N
        wanted = a - f * N @ s / sqrt(s @ N @ s)
        assert [dp, w * dp + p_dw] == pytest.approx(wanted, rel=1e-12, abs=1e-12)


# --- section 5 ----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["damped", "static coefficient"])
def test_the_branch_of_a_take_off(name):
    """(M19) is what a step comes to as its size goes to zero; its error is of the next order."""
    problem, held, taken = walk(name)
    first = next(step for step in taken if step.before.r == 0.0)
    each = equations_of(name, first)
    (a_1, a_2), (da_1, da_2), (c_11, c_12), slope = each.a, each.db, each.c[0], each.df
    assert a_2 == pytest.approx(0.0, abs=1e-9 * a_1)
    excess = each.dp if name == "static coefficient" else 0.0  # or else rounding
    off = []
    for h in (1e-7, 1e-8):
        memory = first.state.memory._replace(plan=(h, *first.state.memory.plan[1:]))
        after, _ = turn(name, problem, held, first.state._replace(memory=memory))
        assert after.memory.h_last == h
        p, w = after.memory.p[3], after.memory.w[3]
        along = excess * h + (da_1 - (c_11 + slope) * excess) * h * h / 2
        across = (da_2 - c_12 * excess) / (a_1 + excess) * h
        off.append([p / along - 1, w / across - 1])
    assert np.abs(off[0]).max() < 0.1
    assert (np.abs(off[1]) < 0.15 * np.abs(off[0]) + 1e-6).all()


def test_the_turn_follows_from_its_balance_of_forces_at_zero_slip():
    """(M15): there the derivative of (M14) by w is a_1 + f tau'."""
    each = Step(rebuild(ELLIPSE, Motion(0.0, 1e-3, 2e-6, 0.0, 0.6, 0.8)))
    h, p, w = 1e-7, np.array([1e-9, 1e-9, 0.0]), np.array([0.0, 0.1, 0.2])
    f, _, _, (_, dtau) = each.friction(p, w)
    wanted = h * (each.accelerations(h, p, w)[0] + f * dtau)[2]
    assert each.equations(h, p, w)[1][5, 5] == pytest.approx(wanted, rel=1e-12)
    assert wanted != 0.0


@pytest.mark.parametrize("excess", [0.0, 0.5])
def test_all_but_one_solution_leaves_a_take_off(excess):
    """(M20) solves p w' = -a_1 w to leading order, and has no bound as t goes to zero."""
    a_1, rate = 8.0, 300.0

    def w(t):
        return t ** (-a_1 / excess) if excess else exp(2 * a_1 / (rate * t))

    for t in (1e-2, 2e-2, 4e-2):
        p = excess * t if excess else rate * t * t / 2
        change = (w(t * (1 + 1e-5)) - w(t * (1 - 1e-5))) / (2e-5 * t)
        assert p * change == pytest.approx(-a_1 * w(t), rel=1e-6)
    assert w(1e-3) > 1e20 * w(1e-1)


def test_where_slip_starts_on_an_ellipse():
    """(M18), beyond the ellipse, where friction holds no more, and on it."""
    problem, _ = problem_of(ELLIPSE)
    n, f = problem.surface, 8.0
    N = np.array([[n.xx, n.xy], [n.xy, n.yy]])
    for a in ([9.0, 3.0], [-1.0, 12.0], 8.0 * np.linalg.cholesky(N) @ [0.6, 0.8]):
        y = np.array(takeoff(problem, tuple(a), f))
        rest = a - f * N @ y / sqrt(y @ N @ y)
        assert rest @ [-y[1], y[0]] == pytest.approx(0.0, abs=1e-11 * f * np.linalg.norm(y))
        assert rest @ y >= -1e-11 * f * np.linalg.norm(y)


# --- sections 10 to 12 --------------------------------------------------------------------------


def test_the_weights_of_the_defect():
    """(M36); the error is largest at the first node, and zero at the end."""
    inside = np.abs(PI.integ()(np.linspace(0.0, 1.0, 10_001)))
    assert inside.max() == pytest.approx(abs(PI.integ()(C[0])), rel=1e-6)
    assert PI.integ()(1.0) == pytest.approx(0.0, abs=1e-15)
    assert (f"{gamma(0.4):.5f}", f"{gamma(0.85):.5f}") == ("0.18830", "0.31714")


@pytest.mark.parametrize("name", SLIDERS)
def test_the_printed_error_estimate_is_the_solver_s(name):
    """Where it is not so small that the solver forgets it.

    A defect is a difference of terms that are rounded; about steady sliding it is held against
    a motion of rounding over the tolerance.
    """
    _, held, taken = walk(name)
    seen = [step for step in taken if step.error > 0.0]
    assert len(seen) > 5
    for step in seen:
        error = equations_of(name, step).error(step.h, step.p, step.w)
        assert error / held.tolerance == pytest.approx(step.error, rel=1e-6)


def test_the_local_tolerance():
    """(M39) and (M34)."""
    segment = next(segments(DAMPED, 0.0, 1.0))
    for rtol in (1e-2, 1e-6, 1e-10):
        held = accuracy(DAMPED, scales_of(DAMPED, st.Initial()), segment, 0.0, rtol)
        tol = 0.8 * rtol ** (4 / 5)
        assert held.tolerance == tolerance(rtol) == pytest.approx(tol, rel=1e-14)
        assert held.newton == pytest.approx(min(0.2, 100 * sqrt(tol)) * tol, rel=1e-14)


def test_the_speed_to_be_resolved():
    """(M40): V sin(phi), less what friction weakens; its steepest slope is (mu_0 - mu_inf)/v_f."""
    _, held = problem_of(DAMPED)
    s, law = DAMPED, DAMPED.law
    nu = (law.mu_0 - law.mu_inf) / law.v_f * s.normal_load
    wanted = s.drive.velocity * sin(s.phi) / (1 + nu**2 / (s.k_y * s.mass))
    assert held.speed == pytest.approx(wanted, rel=1e-9)
    assert held.free_x == pytest.approx(s.F_0 / sqrt(s.mass * s.k_x), rel=1e-14)
    assert held.drive == pytest.approx(s.drive.velocity * cos(s.phi), rel=1e-14)


def test_the_next_step_size():
    """(M43), where nothing is planned and the errors of a step and of the one before are kept."""
    _, _, taken = walk("strongly damped")
    checked = 0
    for before, step, following in zip(taken, taken[1:], taken[2:], strict=False):
        if not before.error or not step.error or step.state.memory.place < 8:
            continue
        n = step.state.memory
        if not n.warm or following.state.memory.place < 8 or step.h < 0.9 * n.h:
            continue
        theta, last = (each.error + 1e-10 for each in (step, before))
        theta, last = theta**-0.25, last**-0.25
        trend = max(0.2, 0.9 * step.h / before.h * theta**2 / last)
        wanted = step.h * min(2.0, max(0.2, 0.9 * theta), trend)
        assert following.state.memory.h == pytest.approx(wanted, rel=1e-8)
        checked += 1
    assert checked > 5


# --- sections 3 and 13 --------------------------------------------------------------------------


@pytest.mark.parametrize("name", SLIDERS)
def test_a_slip_ends_along_the_force(name):
    """(M29) at the last stage of a landing: a_2 - w a_1 - f tau = 0 there."""
    for step in walk(name)[2]:
        if step.p[2] == 0.0:
            each = equations_of(name, step)
            a_1, a_2 = each.accelerations(step.h, step.p, step.w)[:, 2]
            f, _, _, (tau, _) = each.friction(0.0, step.w[2])
            assert a_2 - step.w[2] * a_1 - f * tau == pytest.approx(0.0, abs=1e-9 * abs(a_1))


@pytest.mark.parametrize("s", [(2.0, 0.0), (1.0, -3.0), (-0.5, 0.2)])
def test_the_integrals_of_the_pursuit_curve(s):
    """(M48), by the chain rule, with s' = a - f s/|s|."""
    a, f, s = np.array([3.0, 1.0]), 8.0, np.array(s)
    r, Q, across = hypot(*s), a @ s, np.array([-a[1], a[0]]) / hypot(*a)
    b, change = s @ across, a - f * s / r
    dr, dQ, db, square = s @ change / r, a @ change, change @ across, a @ a
    assert f * dr + dQ == pytest.approx(square - f * f)
    wanted = (square - 2 * f * f) * Q + f * square * r
    assert f * (dr * Q + r * dQ) + Q * dQ == pytest.approx(wanted)
    assert 2 * r * dr == pytest.approx(2 * Q - 2 * f * r)
    wanted = (square - 4 * f * f) * b
    assert (2 * f * dr + dQ) * b + (2 * f * r + Q) * db == pytest.approx(wanted)


@pytest.mark.parametrize("a", [(2.0, 1.0), (6.0, 3.0)])
def test_how_a_slip_turns_at_its_end(a):
    """(M51): angles to the force go as (T - t)^kappa."""
    f, left = 8.0, np.geomspace(1e-6, 1e-5, 4)
    kappa = hypot(*a) / (f - hypot(*a))
    slips = [plain(slip_before_landing)(1e-3, *a, f, each)[1:] for each in left]
    angles = [atan2(a[1], a[0]) - atan2(across, along) for along, across in slips]
    exponent, _ = np.polyfit(np.log(left), np.log(angles), 1)
    assert exponent == pytest.approx(kappa, rel=1e-2)


@pytest.mark.parametrize("driven", ["plate", "spring"])
def test_the_end_of_a_stick_under_any_drive(driven):
    """(M6) to (M9): the first zero of the margin, whose curvature keeps its bound."""
    drive = st.protocols.DriveProgram(
        velocity="2 mm/s",
        along=st.protocols.Modulation("3 mm/s", 40.0),
        program=[st.protocols.Ramp("4 mm/s", 1.0)],
    )
    load = st.protocols.LoadProgram(modulation=st.protocols.Modulation("0.5 N", 70.0))
    s = DAMPED.replace(friction=st.Coulomb(0.2), drive=drive, load=load, driven=driven)
    bound, v_d = next(segments(s, 0.0, 1.0)).problem.bend.value, np.array(s.direction)
    K, damping = np.array([s.k_x, s.k_y]), np.array([s.c_x, s.c_y])

    def margin(t):
        omega = 2 * pi * 40.0
        way = 2e-3 * t + 1e-3 * t * t + 3e-3 * (1 - cos(omega * t)) / omega
        rate, change = 2e-3 * (1 + t) + 3e-3 * sin(omega * t), 2e-3 + 3e-3 * omega * cos(omega * t)
        inertia = change if driven == "plate" else 0.0
        a = (K * v_d * way + damping * v_d * rate) / s.mass + inertia * v_d
        f_s = s.law.mu_0 * (s.normal_load + 0.5 * sin(2 * pi * 70.0 * t)) / s.mass
        return a @ a - f_s**2

    t, dt = np.linspace(0.0, 0.02, 4001), 5e-6
    M = np.array([margin(each) for each in t])
    curvature = (M[2:] - 2 * M[1:-1] + M[:-2]) / dt**2
    assert (curvature[M[1:-1] <= 0.0] <= bound).all()
    after = int(np.argmax(M > 0.0))
    wanted = brentq(margin, t[after - 1], t[after], xtol=1e-16)
    held = st.Initial(v_x=2e-3 * v_d[0], v_y=2e-3 * v_d[1])
    run = st.simulate(s, 0.02, initial=held, sample_rate=0)
    begins, found = run.stick_intervals[0]
    assert begins == 0.0
    # the end counts as reached at 1e-14 of f_s^2
    slope = (margin(wanted + 1e-7) - margin(wanted - 1e-7)) / 2e-7
    assert found == pytest.approx(wanted, abs=2e-14 * (s.F_0 / s.mass) ** 2 / slope + 1e-15)


def test_what_friction_has_to_spare_in_a_stick():
    """(M10), for a short one: the next term is smaller by the ratio of margin and limit."""
    problem, _ = problem_of(DAMPED)
    u = (0.999 * DAMPED.F_0 / DAMPED.k_x, 0.0)
    tau, _ = stick_duration(problem, 0.0, *u, inf)
    run, times = Solver(DAMPED, 1e-6), np.linspace(0.0, tau, 1001)
    held = [np.hypot(*run.holding(u + run.v_d * t)) for t in times]
    wanted = np.trapezoid(run.f_s - np.array(held), times)
    assert to_spare(problem, 0.0, *u, tau) == pytest.approx(wanted, rel=1e-2)


# --- section 14 ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SLIDERS)
def test_a_sample_is_the_end_of_a_shorter_step(name):
    """Found here by SciPy, from the printed equations."""
    problem, held, taken = walk(name)
    step = max(taken[:10], key=lambda it: it.error if it.p[2] > 0.0 else 0.0)
    nodes, each = np.array([0.0, *C]), equations_of(name, step)
    along = Polynomial.fit(nodes, [step.before.r, *step.p], 3, domain=[0, 1])
    turned = Polynomial.fit(nodes, [0.0, *step.w], 3, domain=[0, 1])
    scale = np.repeat([step.p.max(), np.abs(step.w).max()], 3)
    for part in (0.3, 0.6, 0.95):
        dt = part * step.h
        guess = np.concatenate([along(C * part), turned(C * part)])
        solved = root(
            lambda x, dt=dt: each.equations(dt, *(x * scale).reshape(2, 3))[0] / scale,
            guess / scale,
            tol=1e-14,
        )
        p, w = (solved.x * scale).reshape(2, 3)
        u, r, e = each.end(dt, p, w)
        _, samples = turn(name, problem, held, step.state, [step.before.t + dt])
        # the time of the sample is rounded
        rounding = 1e-9 * r + 4e-16 * step.before.t * abs(each.a[0])
        assert samples[0, :2] == pytest.approx(u, rel=1e-11)
        assert samples[0, 2:4] == pytest.approx(r * e, abs=rounding)


# --- section 15 ---------------------------------------------------------------------------------


@pytest.mark.parametrize("beyond", [1e-6, 1e-4, 1e-2])
def test_the_edge_along_a_principal_axis(beyond):
    """(M56): p = V - A cos(omega t) about its minimum, with A slightly above V."""
    V, omega = 0.1, 10.0
    A = V * (1 + beyond)
    slider = st.Slider(
        mass=1.0,
        k_x=omega**2,
        k_y=omega**2,
        phi="0 deg",
        normal_load=10.0,
        friction=st.Coulomb(0.3),
        drive=st.ConstantVelocity(V),
    )
    lowest = st.Initial(u_x=3.0 / omega**2 - A / omega, v_x=0.0, v_y=0.0)
    run = st.simulate(slider, pi / omega, initial=lowest, rtol=1e-10, sample_rate=0)
    ((landed, ended),) = run.stick_intervals
    angle, quarter = acos(V / A), pi / (2 * omega)
    assert ended - landed == pytest.approx(tan(angle) / omega, rel=1e-6)
    assert landed == pytest.approx(quarter - angle / omega, rel=1e-9)
    assert ended - quarter == pytest.approx((tan(angle) - angle) / omega, abs=1e-6 * angle / omega)


def cycle(theta):
    """Return time and time held of the cycle from an angle (M52) to (M54), or None if it is long.

    The paper's apparatus, whose cycles take 1 to 2.6 ms.
    """
    s, v = PAPER, PAPER.drive.velocity * np.array(PAPER.direction)
    k = np.array([s.k_x, s.k_y])
    force, change = s.F_0 * np.array([cos(theta), sin(theta)]), k * v
    lead = force @ change / (change @ change)
    u_x, u_y = force / k - v * lead
    before = st.Initial(u_x=u_x, u_y=u_y, v_x=v[0], v_y=v[1])
    run = st.simulate(s, lead + 4e-3, initial=before, rtol=1e-12, sample_rate=0)
    sticks = run.stick_intervals - lead
    assert sticks[0] == pytest.approx([-lead, 0.0], abs=1e-12 * lead)
    if len(sticks) < 2:
        return None
    return sticks[1, 1], sticks[1, 1] - sticks[1, 0]


def test_the_edge_of_the_return_map_has_the_exponent_one_half():
    """(M55); beside it the time of a cycle has a slope there, and a term of the power 3/2."""
    low, high = np.radians([20.0, 25.0])
    for _ in range(45):
        middle = (low + high) / 2
        low, high = (low, middle) if cycle(middle) else (middle, high)
    distance = np.geomspace(1e-6, 1e-4, 9)
    time, held = np.array([cycle(high + each) for each in distance]).T
    exponent, _ = np.polyfit(np.log(distance), np.log(held), 1)
    assert exponent == pytest.approx(0.5, abs=1e-3)  # the next term is of the order of d
    x = np.sqrt(distance / distance[-1])  # time = a + b x^2 + c x^3 + d x^4
    powers = np.array([x**0, x**2, x**3, x**4]).T
    rough, fine = (np.linalg.lstsq(powers[:, kept], time)[1] for kept in ([0, 1, 3], [0, 1, 2, 3]))
    assert fine < 0.01 * rough


# --- section 16 ---------------------------------------------------------------------------------

AGEING = st.laws.RateStateAgeing(a=0.01, b=0.015, D_c="10 um", mu_star=0.6, V_star="1 um/s")


@pytest.mark.parametrize("speed", [1e-30, 1e-9, 1.0])
def test_rate_and_state_friction_is_linear_in_the_slip_coordinate(speed):
    """(M61) and (M64)."""
    slip, load, states = (0.6 * speed, -0.8 * speed), 10.0, (2.0,)
    eps = 2 * AGEING.V_star * exp(-(AGEING.mu_star + AGEING.b * states[0]) / AGEING.a)
    assert AGEING.grain(states) == pytest.approx(eps, rel=1e-13)
    q = coordinate(eps, *slip)
    assert hypot(*q) == pytest.approx(asinh(speed / eps), rel=1e-13)
    force = AGEING.force(slip, load, states)
    assert force == pytest.approx([AGEING.a * load * each for each in q], rel=1e-12)
    assert slip_at(eps, *q) == pytest.approx(slip, rel=1e-12)


@pytest.mark.parametrize("q", [(1e-6, 2e-6), (0.3, -0.4), (3.0, 20.0)])
def test_the_slope_of_the_slip_coordinate(q):
    """(M65), by differences."""
    eps, step = 1e-9, 1e-5
    by_x = np.subtract(slip_at(eps, q[0] + step, q[1]), slip_at(eps, q[0] - step, q[1]))
    by_y = np.subtract(slip_at(eps, q[0], q[1] + step), slip_at(eps, q[0], q[1] - step))
    wanted = by_x[0], by_x[1], by_y[1]
    found = np.array(slip_and_slope(eps, *q)[2:]) * 2 * step
    assert found == pytest.approx(wanted, abs=1e-8 * np.abs(wanted).max())


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_a_damped_update(share):
    """(M69), to a thousandth, as iterates need."""
    q, rise = 3.0, 5.0
    up = damped_rise(q, rise, share)
    left = share * (np.sinh(up) - np.sinh(q)) / np.cosh(q) + (1 - share) * (up - q)
    assert left == pytest.approx(rise, rel=1e-2)


@pytest.mark.parametrize("law", [st.laws.RateStateAgeing, st.laws.RateStateSlip])
def test_the_logarithmic_state(law):
    """(M62) is the law for theta."""
    law = law(*AGEING)
    slip, zeta = 3e-6, 1.3
    theta = law.D_c / law.V_star * exp(zeta)
    x = slip * theta / law.D_c
    wanted = (1 - x if isinstance(law, st.laws.RateStateAgeing) else -x * log(x)) / theta
    assert law.change((slip, 0.0), 1.0, (zeta,)) == pytest.approx((wanted,), rel=1e-13)


@pytest.mark.parametrize("slip", [(3e-7, -4e-7), (2e-3, 1e-3), (0.0, 0.0)])
@pytest.mark.parametrize("surface", [Isotropic(), Elliptic(1.0, 0.2, 0.6)])
@pytest.mark.parametrize("kind", [Smoothed, SmoothedByArctan])
def test_the_derivatives_of_a_smoothed_law(slip, surface, kind):
    """Those of (M60), by differences: what is compiled has both from one call."""
    law, load, delta = PAPER.law, 10.0, 1e-6
    smoothed = kind(law, surface, delta)
    compiled = SMOOTHED(smoothed, slip, load)
    assert compiled[:2] == pytest.approx(smoothed.force(slip, load, ()), rel=1e-14)
    h = 1e-5 * max(delta, hypot(*slip))
    sides = [
        (smoothed.force((slip[0] + x, slip[1] + y), load, ()), (x or y))
        for x, y in ((h, 0.0), (-h, 0.0), (0.0, h), (0.0, -h))
    ]
    (ahead, _), (behind, _), (up, _), (down, _) = sides
    by_x, by_y = (np.subtract(a, b) / (2 * h) for a, b in ((ahead, behind), (up, down)))
    wanted = [by_x[0], by_y[0], by_x[1], by_y[1]]
    assert compiled[2:] == pytest.approx(wanted, abs=1e-7 * np.abs(wanted).max())


@pytest.mark.parametrize("x", [0.0, 1e-5, 0.999e-3, 1.001e-3, 1.0, 1e3])
def test_the_arc_tangent_of_a_smoothed_law(x):
    """h = (2/pi) atan(q/delta)/q and -h'/(q h), by hand; the series is off by x^4."""
    delta = 2e-3
    h, fall = SmoothedByArctan(None, None, delta).slip_factor((x * delta) ** 2)
    exact = atan(x) / x if x else 1.0
    assert h == pytest.approx(2 / pi / delta * exact, rel=1e-11)
    if x >= 0.9e-3:
        steeper = (exact - 1 / (1 + x * x)) / (exact * (x * delta) ** 2)
        assert fall == pytest.approx(steeper, rel=1e-9)
    else:
        assert fall == pytest.approx(2 / 3 / delta**2, rel=1e-9)


def eliminated_and_solved(h, k, c, slope, friction, flow, right):
    """Return the solution of (M68) for slip x, slip y and the states, as the solver has it."""
    n = right.shape[0] - 2
    w = plain(workspace)(n)
    for i in range(3):
        w.jacobian[i + 1] = flow[i]
        for z in range(2, n + 2):
            w.changes[i + 1, z] = -right[z, i] / h  # all that residuals of states are, at z = z_0
    at = Stages(
        (0.0, 0.0, 0.0),
        (0.0, 0.0, 0.0),
        (0.0, 0.0, 0.0),
        (0.0, 0.0, 0.0),
        (slope[0, 0, 0], slope[1, 0, 0], slope[2, 0, 0]),
        (slope[0, 0, 1], slope[1, 0, 1], slope[2, 0, 1]),
        (slope[0, 1, 1], slope[1, 1, 1], slope[2, 1, 1]),
        (friction[0, 0, 0], friction[1, 0, 0], friction[2, 0, 0]),
        (friction[0, 0, 1], friction[1, 0, 1], friction[2, 0, 1]),
        (friction[0, 1, 0], friction[1, 1, 0], friction[2, 1, 0]),
        (friction[0, 1, 1], friction[1, 1, 1], friction[2, 1, 1]),
    )
    x = plain(linear)(h, k[0], c[0], 0.0, (0.0, 0.0, 0.0))
    y = plain(linear)(h, k[1], c[1], 0.0, (0.0, 0.0, 0.0))
    m = plain(factors)(h, x, y, at, w)
    r_x = right[0, 0], right[0, 1], right[0, 2]
    r_y = right[1, 0], right[1, 1], right[1, 2]
    if n > 0:
        r_x, r_y = plain(residuals_without)(h, r_x, r_y, w)
    d_x, d_y = plain(solve_blocks)(m, r_x, r_y)
    if n > 0:
        plain(correct_states)(d_x, d_y, w)
    return d_x, d_y, -w.values[1:4, 2:]


@pytest.mark.parametrize("damped", [False, True])
@pytest.mark.parametrize("number", [0, 1, 2, 3])
def test_elimination_solves_the_printed_equations(number, damped):
    """(M68): all blocks at once by NumPy, against the states eliminated one after the other."""
    draw, n, h = np.random.default_rng(number), number, 1e-3
    size = 2 + n
    flow = draw.normal(size=(3, size, size))
    for k in range(2, size):
        flow[:, k, k] = -np.abs(flow[:, k, k]) / h  # states decay
    slope = draw.normal(size=(3, 2, 2)) * 0.1
    slope = slope + slope.transpose(0, 2, 1) + np.eye(2)
    k, c = draw.uniform(1e4, 1e6, 2), draw.uniform(0.0, 1e2, 2) * damped
    friction = flow[:, :2, :2] @ slope
    matrix = np.zeros((size, 3, size, 3))
    for a in range(2):
        linear = D + h * h * k[a] * A + h * c[a] * np.eye(3)
        for b in range(2):
            matrix[a, :, b] = linear * slope[:, a, b] + np.diag(h * friction[:, a, b])
    for z in range(2, size):
        for b in range(2):
            matrix[z, :, b] = np.diag(-h * np.einsum("ij,ij->i", flow[:, z, :2], slope[:, :, b]))
            matrix[b, :, z] = np.diag(h * flow[:, b, z])
        for other in range(2, size):
            matrix[z, :, other] = (D if z == other else 0.0) - np.diag(h * flow[:, z, other])
    right = draw.normal(size=(size, 3))
    wanted = np.linalg.solve(matrix.reshape(3 * size, -1), right.ravel()).reshape(size, 3)
    d_x, d_y, states = eliminated_and_solved(h, k, c, slope, friction, flow, right)
    found = np.vstack([d_x, d_y, states.T])
    assert found == pytest.approx(wanted, rel=1e-9, abs=1e-9 * np.abs(wanted).max())


def test_the_printed_residuals_of_a_smooth_step_vanish():
    """(M66) and (M67), from the last step that the solver remembers."""
    s = PAPER.replace(friction=AGEING, c_x=3.0, c_y=20.0)
    description = st.simulate(s, 0.02, sample_rate=0).description
    segment = next(segments(s, 0.0, 1.0))
    held = accuracy(s, scales_of(s, description.initial), segment, 0.0, 1e-6)._replace(
        newton=NEWTON
    )
    method = Smooth(s, None)
    held, state = method.step_accuracy(held), method.begin(description)
    problem = method.point_law(segment.problem)
    K, damping = np.array([s.k_x, s.k_y]), np.array([s.c_x, s.c_y])
    v = s.drive.velocity * np.array(s.direction)
    nothing = np.empty(0), np.empty((0, 8)), 0
    rooms = workspace(method.states), workspace(method.states)
    for _ in range(30):
        before = state.motion
        _, now, _, _ = smooth_loop.advance(problem, state, 1e9, held, 1, *nothing, *rooms)
        state = with_numbers(state, now)
        h, past = state.memory.h_last, state.memory.past
        slip, zeta = past[1:, :2], past[1:, 2:]
        u = np.array([before.u_x, before.u_y])
        stages = list(zip(map(tuple, slip), map(tuple, zeta), strict=True))
        force = [s.law.force(a, s.normal_load, b) for a, b in stages]
        change = [s.law.change(a, s.normal_load, b) for a, b in stages]
        b = (K * (u + np.outer(C * h, v)) + damping * v) / s.mass
        lost = (K * h * (A @ slip) + damping * slip + force) / s.mass
        along = D @ (slip - past[0, :2]) - h * (b - lost)
        states = D @ (zeta - past[0, 2:]) - h * np.array(change)
        terms = h * np.abs(b).max() + 10 * np.abs(past[:, :2]).max()
        assert np.abs(along).max() < 1e-9 * terms
        assert np.abs(states).max() < 1e-9 * (1 + np.abs(zeta).max())


# --- the page itself ----------------------------------------------------------------------------


def test_equations_are_numbered_in_order_and_citations_exist():
    """One that came in between has a letter, and follows those of its number."""
    numbers = [int(tag) for tag in TAGS if tag.isdigit()]
    assert numbers == list(range(1, len(numbers) + 1))
    assert sorted(TAGS, key=lambda tag: (int(tag.rstrip("abc")), tag)) == TAGS
    for path in (ROOT / "src/stiction").rglob("*.py"):
        cited = re.findall(r"\(M(\d+[a-z]?)\)", path.read_text(encoding="utf-8"))
        assert set(cited) <= set(TAGS), path


def test_every_equation_is_held_by_a_test():
    """One that names its number."""
    cited = set()
    for path in (ROOT / "tests").rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        for first, letter, last in re.findall(r"\(M(\d+)([a-z]?)\)(?: to \(M(\d+)\))?", text):
            cited |= {first + letter, *map(str, range(int(first), int(last or 0) + 1))}
    assert set(TAGS) - cited == set()


def test_the_files_named_beside_the_text_exist():
    """Section 20; a name after one in a folder is in that folder too."""
    table = TEXT.partition("## 19.")[2].partition("`reference.py`")[0]
    lines = re.findall(r"^\| \d+ \| (.*) \|$", table, re.MULTILINE)
    assert len(lines) == 16
    for line in lines:
        folder = SOLVER
        for name in re.findall(r"[\w./]+(?:\.py|/)(?=[ ,;|]|$)", line):
            path = SOLVER / name if (SOLVER / name).exists() else folder / name
            assert path.exists(), name
            folder = path.parent


def printed_constants():
    """Yield file, name and value of each line of the table in section 18."""
    for line in TEXT.splitlines():
        found = re.match(r"\| ([a-z_/]+\.py) \| ([A-Z_]+) \| (\S+) \|", line)
        if found:
            yield found[1], found[2], float(found[3])


@pytest.mark.parametrize(("file", "name", "value"), list(printed_constants()))
def test_a_printed_constant_is_the_code_s(file, name, value):
    module = importlib.import_module(f"stiction.solver.{file[:-3].replace('/', '.')}")
    assert getattr(module, name) == pytest.approx(value, rel=1e-6)


def test_a_name_of_a_constant_has_one_value():
    names = [name for _, name, _ in printed_constants()]
    assert sorted(set(names)) == sorted(names)


def test_every_constant_is_printed():
    """Plain numbers with a name of their own; codes of how a run ends are none."""
    printed = {(file, name) for file, name, _ in printed_constants()}
    apart = {
        "interrupt.py",
        "machine_code.py",
        "refusal.py",
        "reference.py",
        "record.py",
        "sampling.py",
        "turn.py",
        "workspace.py",
    }
    for path in SOLVER.rglob("*.py"):
        file = path.relative_to(SOLVER).as_posix()
        if path.name in apart:
            continue
        for line in path.read_text(encoding="utf-8").splitlines():
            found = re.match(r"([A-Z_]{3,}(?:, [A-Z_]{3,})*) = ([-\d.e_, ]+)(?: *#.*)?$", line)
            for name in found[1].split(", ") if found and "RUNNING" not in found[1] else ():
                assert (file, name) in printed, "a constant without a name in section 18"
