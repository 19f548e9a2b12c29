"""The method as ``docs/method.md`` prints it, against the compiled solver.

The equations are written down once more in NumPy, under the numbers that they have there. Steps
are the solver's own: one turn of its loop at a time, whose stages it remembers.
"""

import importlib
import re
from functools import cache
from math import acos, asinh, atan2, cos, exp, hypot, inf, log, pi, sin, sqrt, tan
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.optimize import brentq, minimize_scalar, root
from tests.entry import entry

import stiction as st
import stiction.solver
from stiction.solver.block_algebra import solved
from stiction.solver.compilation.jit import called
from stiction.solver.exact.loop import steps
from stiction.solver.integrate import accuracy, tolerance
from stiction.solver.law import pointed
from stiction.solver.problem import Elliptic, Isotropic, kinds_of
from stiction.solver.segments import stretches
from stiction.solver.smooth import loop as smooth_loop
from stiction.solver.smooth.coordinate import coordinate, risen, slip_at, slip_slope
from stiction.solver.smooth.dispatch import Smoothed, friction_and_gradient
from stiction.solver.smooth.elimination import correct_states, residuals_without
from stiction.solver.smooth.method import Smooth
from stiction.solver.smooth.newton import factors, linear
from stiction.solver.smooth.right_hand_side import Stages
from stiction.solver.smooth.workspace import workspace
from stiction.solver.state import Motion, State, named, start
from stiction.solver.stick import stick_duration, to_spare
from stiction.solver.surface import takeoff

ROOT = Path(__file__).parents[3]
TEXT = (ROOT / "docs/method.md").read_text(encoding="utf-8")
SOLVER = Path(stiction.solver.__file__).parent

coordinate, risen, slip_at, slip_slope = map(entry, (coordinate, risen, slip_at, slip_slope))
stick_duration, takeoff, to_spare = map(entry, (stick_duration, takeoff, to_spare))

SMOOTHED = numba.njit(lambda law, slip, load: friction_and_gradient(law, slip, load))

NEWTON = 1e-11  # what corrections are iterated to here, so that residuals vanish
C = np.array([(4 - sqrt(6)) / 10, (4 + sqrt(6)) / 10, 1.0])
LAGRANGE = [Polynomial.fromroots(np.delete(C, j)) for j in range(3)]
LAGRANGE = [basis / basis(C[j]) for j, basis in enumerate(LAGRANGE)]
A = np.array([[basis.integ()(c) for basis in LAGRANGE] for c in C])  # (M24)
D = np.linalg.inv(A)
PI = Polynomial.fromroots(C)  # (M35)


def weight(c):
    """(M36)."""
    return abs(PI.integ()(C[0]) / PI(c))


# --- the printed equations ----------------------------------------------------------------------


class Printed:
    """Equations (M11) to (M42) of one step of slip, for a steady drive and load."""

    def __init__(self, problem, motion):
        s, (_, u_x, u_y, self.r, e_x, e_y) = problem.system, motion
        self.m, self.law = s.mass, problem.law
        self.K, self.C = np.diag([s.k_x, s.k_y]), np.diag([s.c_x, s.c_y])
        self.v = problem.drive.velocity * np.array([s.cos_phi, s.sin_phi])
        self.W, self.u = problem.load.force, np.array([u_x, u_y])
        n = problem.surface
        self.e, self.n = np.array([e_x, e_y]), np.array([-e_y, e_x])
        self.axes = np.array([self.e, self.n])
        self.k = self.axes @ self.K @ self.axes.T / self.m
        self.c = self.axes @ self.C @ self.axes.T / self.m
        self.N = self.axes @ np.array([[n.xx, n.xy], [n.xy, n.yy]]) @ self.axes.T

    def b(self, t):
        """(M17)."""
        return self.axes @ (self.K @ (self.u + self.v * t) + self.C @ self.v) / self.m

    def friction(self, p, w):
        """Return f, n_1, tau and tau' (M12), (M16)."""
        (xx, xy), (_, yy) = self.N
        g = sqrt(xx + 2 * xy * w + yy * w * w)
        n_1, n_2 = (xx + xy * w) / g, (xy + yy * w) / g
        dn_1, dn_2 = (xy - n_1 * n_2) / g, (yy - n_2 * n_2) / g
        f = self.law.coefficient(p * sqrt(1 + w * w)) * self.W / self.m
        return f, n_1, n_2 - w * n_1, dn_2 - n_1 - w * dn_1

    def outset(self):
        """Return a_1, a_2 and dp/dt, and what accelerates across, at the start."""
        a = self.b(0.0) - self.c @ [self.r, 0.0]
        f, n_1, tau, _ = self.friction(self.r, 0.0)
        return (*a, a[0] - f * n_1, a[1] - f * tau)

    def oscillation(self, h):
        """Return p, dp/dt and the distance as functions of time (M21) to (M23), or None."""
        k, r = self.k[0, 0], self.r
        slope = self.law.slope(r) * self.W / self.m * self.friction(r, 0.0)[1]
        beta = (self.c[0, 0] + slope) / 2
        if not (1e-3 < k * h * h < 6.25 and abs(beta) < 0.2 * sqrt(k)):
            return None
        P = (self.k @ self.axes @ self.v)[0] / k
        x_0, v_0, omega = r - P, self.outset()[2], sqrt(k - beta**2)

        def at(t):
            U, S = exp(-beta * t) * np.array([cos(omega * t), sin(omega * t) / omega])
            x, v = x_0 * U + (v_0 + beta * x_0) * S, v_0 * U - (beta * v_0 + k * x_0) * S
            return P + x, v, P * t + (v_0 - v + 2 * beta * (x_0 - x)) / k

        return at

    def residuals(self, h, p, w):
        """(M25) to (M29)."""
        p, w, R, Z = np.array(p), np.array(w), np.zeros(3), np.zeros(3)
        laid = self.oscillation(h)
        if laid:
            below, change, slid = np.array([laid(c * h) for c in C]).T
            R, Z = h * change - D @ (below - self.r), slid / h - A @ below
        q = p * w
        z = h * np.array([A @ p + Z, A @ q])
        a = np.array([self.b(c * h) for c in C]).T - self.k @ z - self.c @ [p, q]
        f, n_1, tau, _ = np.array([self.friction(*each) for each in zip(p, w, strict=True)]).T
        along = D @ (p - self.r) + R - h * (a[0] - f * n_1)
        across = p * (D @ w) - h * (a[1] - w * a[0] - f * tau)
        return np.concatenate([along, across]), h * np.abs(a).max(), z[:, 2]

    def jacobian(self, h, p, w):
        """(M31)."""
        p, w, k, c = np.array(p), np.array(w), self.k, self.c
        laid = self.oscillation(h)
        Z = [
            laid(each * h)[2] / h - row @ [laid(x * h)[0] for x in C]
            for row, each in zip(A, C, strict=True)
        ]
        z_1, z_2 = h * (A @ p + Z), h * (A @ (p * w))
        rows = np.zeros((6, 6))
        for i in range(3):
            f, n_1, tau, dtau = self.friction(p[i], w[i])
            dn_1 = (
                (self.N[0, 1] - n_1 * (tau + w[i] * n_1))
                * n_1
                / (self.N[0, 0] + self.N[0, 1] * w[i])
            )
            chi_p = sqrt(1 + w[i] ** 2)
            chi_w = p[i] * w[i] / chi_p
            slope = self.law.slope(p[i] * chi_p) * self.W / self.m
            a_1 = (self.b(C[i] * h) - k @ [z_1[i], z_2[i]] - c @ [p[i], p[i] * w[i]])[0]
            kappa_1, kappa_2 = k[0, 1] - w[i] * k[0, 0], k[1, 1] - w[i] * k[0, 1]
            rows[i, :3] = D[i] + h * h * A[i] * (k[0, 0] + k[0, 1] * w)
            rows[i, 3:] = h * h * A[i] * k[0, 1] * p
            rows[3 + i, :3] = h * h * A[i] * (kappa_1 + kappa_2 * w)
            rows[3 + i, 3:] = p[i] * D[i] + h * h * A[i] * kappa_2 * p
            rows[i, i] += h * (slope * chi_p * n_1 + c[0, 0] + c[0, 1] * w[i])
            rows[i, 3 + i] += h * (slope * chi_w * n_1 + f * dn_1 + c[0, 1] * p[i])
            damping = c[0, 1] + c[1, 1] * w[i] - w[i] * (c[0, 0] + c[0, 1] * w[i])
            rows[3 + i, i] += D[i] @ w + h * (damping + slope * chi_p * tau)
            damping = (c[1, 1] - w[i] * c[0, 1]) * p[i]
            rows[3 + i, 3 + i] += h * (a_1 + damping + slope * chi_w * tau + f * dtau)
        return rows

    def by_step_size(self, h, p, w):
        """(M44) to (M46)."""
        p, w, k = np.array(p), np.array(w), self.k
        laid, change = self.oscillation(h), k @ self.axes @ self.v
        below, rate, slid = np.array([laid(c * h) for c in C]).T
        P = change[0] / k[0, 0]
        slope = self.law.slope(self.r) * self.W / self.m * self.friction(self.r, 0.0)[1]
        curve = -(self.c[0, 0] + slope) * rate - k[0, 0] * (below - P)
        R = rate + h * C * curve - D @ (C * rate)
        hZ = C * below - A @ (below + h * C * rate)
        z = np.array([h * (A @ p) + slid - h * (A @ below), h * (A @ (p * w))])
        by_h = np.array([A @ p + hZ, A @ (p * w)])
        da_1, da_2 = np.outer(change, C) - k @ by_h
        a_1, a_2 = np.array([self.b(c * h) for c in C]).T - k @ z - self.c @ [p, p * w]
        f, n_1, tau, _ = np.array([self.friction(*each) for each in zip(p, w, strict=True)]).T
        along = f * n_1 - a_1 - h * da_1 + R
        return np.concatenate([along, w * a_1 - a_2 + f * tau - h * (da_2 - w * da_1)])

    def after(self, h, p, w):
        """Return u, r and e at the end of the step (M30)."""
        z, stretch = self.residuals(h, p, w)[2], sqrt(1 + w[2] ** 2)
        u = self.u + self.v * h - z @ self.axes
        return *u, p[2] * stretch, *((self.e + w[2] * self.n) / stretch)

    def motion(self, held):
        """(M42)."""
        _, _, along, across = self.outset()
        change, curve = self.v - self.r * self.e, -np.array([along, across]) @ self.axes
        square = change @ change + curve @ (self.m * np.linalg.solve(self.K, curve))
        return max(sqrt(square), held.least)

    def error(self, h, p, w, held):
        """(M38), at the one point or at both."""
        points = (0.4, 0.85) if self.k[0, 0] * h * h > 6.25 else (0.4,)
        return max(self.error_at(c, h, p, w, held) for c in points)

    def error_at(self, c, h, p, w, held):
        """(M37) and (M41)."""
        nodes, gamma, laid = np.array([0.0, *C]), weight(c), self.oscillation(h)
        below = [laid(x * h) if laid else (0.0, 0.0, 0.0) for x in (*nodes, c)]
        under, change, slid = np.array(below).T
        if not laid:
            under[:4] = 0.0
        rest = np.polynomial.Polynomial.fit(nodes, [self.r, *p] - under[:4], 3, domain=[0, 1])
        turn = np.polynomial.Polynomial.fit(nodes, [0.0, *w], 3, domain=[0, 1])
        integrals = np.array([basis.integ()(c) for basis in LAGRANGE])
        z_1 = h * (integrals @ (np.array(p) - under[1:4])) + slid[4]
        z_2 = h * (integrals @ (np.array(p) * w))
        p_in, p_c = rest(c) + under[4], rest.deriv()(c) + h * change[4]
        w_in, w_c = turn(c), turn.deriv()(c)
        a_1, a_2 = self.b(c * h) - self.k @ [z_1, z_2] - self.c @ [p_in, p_in * w_in]
        f, n_1, tau, dtau = self.friction(p_in, w_in)
        off_p = p_c - h * (a_1 - f * n_1)
        off_w = p_in * w_c - h * (a_2 - w_in * a_1 - f * tau)
        off_w /= p_in + gamma * h * abs(a_1 + f * dtau)
        off_x, off_y = np.array([off_p, w_in * off_p + p_in * off_w]) @ self.axes
        rate_x, rate_y = np.abs(self.v - p_in * np.array([1.0, w_in]) @ self.axes)
        sigma, size, most = held.speed, p_in * sqrt(1 + w_in**2), self.motion(held)
        H = min(size, held.drive)
        S = min(sigma + H, most)
        S_x = min(sigma + min(H, rate_x + held.free_x), most)
        S_y = min(sigma + min(H, rate_y + held.free_y), most)
        return gamma * max(
            abs(off_p) / S,
            abs(off_w) * (sigma + size) / S,
            abs(off_x) / S_x,
            abs(off_y) / S_y,
        )


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
    stretch = next(stretches(slider, 0.0, 1.0))
    held = accuracy(slider, st.Initial(), stretch, 0.0, rtol)
    return stretch.problem, held._replace(newton=NEWTON)


def turn(problem, held, state, times=()):
    """Let the loop turn once; return the state and the samples."""
    times, sticks = np.array(times, dtype=float), np.zeros((8, 2))
    samples = np.full((len(times), 7), np.nan)
    state = state._replace(counts=state.counts._replace(sticks=0, stuck=0.0))
    problem = problem._replace(law=pointed(problem.law))
    arguments = problem, state, 1e9, held, 1, times, samples, 0, sticks
    _, after, _, _ = called(steps, kinds_of(problem), *arguments)
    return named(after), samples


def end_of_stick(problem, motion):
    """Return the motion at the end of a stick, by (M5) to (M7) and (M18)."""
    s, v = problem.system, Printed(problem, motion).v
    n = problem.surface
    N, k, c = np.array([[n.xx, n.xy], [n.xy, n.yy]]), [s.k_x, s.k_y], [s.c_x, s.c_y]
    per_weight, u = problem.load.force / s.mass, np.array([motion.u_x, motion.u_y])
    f = problem.law.coefficient(0.0) * per_weight
    f_s = max(getattr(problem.law, "mu_static", 0.0) * per_weight, f)
    a, j = (k * u + c * v) / s.mass, k * v / s.mass
    M, half, q = (x @ np.linalg.solve(N, y) for x, y in ((a, a), (a, j), (j, j)))
    M -= f_s**2
    tau = (sqrt(half**2 - q * M) - half) / q if M < 0.0 else 0.0
    u, a = u + v * tau, a + j * tau
    # the point of the ellipse nearest to a, by its angle
    L = f * np.linalg.cholesky(N)
    if problem.surface.isotropic():
        y = a
    else:
        first = atan2(*np.linalg.solve(L, a)[::-1])

        def distance(angle):
            return np.sum((a - L @ [cos(angle), sin(angle)]) ** 2)

        best = minimize_scalar(distance, (first - 0.1, first + 0.1), tol=1e-14).x
        y = np.linalg.solve(N, L @ [cos(best), sin(best)])
    return Motion(motion.t + tau, *u, 0.0, *(y / np.linalg.norm(y)))


@cache
def walk(name):
    """Return what the solver works on, and the steps of slip that a run takes from a stick on."""
    problem, held = problem_of(SLIDERS[name])
    state, found = start(SLIDERS[name], 0.0, (0.0, 0.0), (0.0, 0.0)), []
    for _ in range(50):
        before = state.motion
        if before.r == 0.0:
            before = end_of_stick(problem, before)
        after, _ = turn(problem, held, state)
        m = after.memory
        if after.counts.steps > state.counts.steps:
            error = m.ease**-4 - 1e-10 if m.ease < 3.0 else 0.0
            stages = np.array(m.p[1:]), np.array(m.w[1:])
            found.append(Taken(state, before, after.motion, m.h_last, *stages, error))
        state = after
    return problem, held, found


def test_the_steps_looked_at_are_of_all_kinds():
    """Take-offs, landings, laid over the oscillation or not, longer than it."""
    seen = set()
    for name in SLIDERS:
        problem, _, taken = walk(name)
        for step in taken:
            printed = Printed(problem, step.before)
            seen.add("take-off" if step.before.r == 0.0 else "")
            seen.add("landing" if step.p[2] == 0.0 else "")
            seen.add("long" if printed.k[0, 0] * step.h**2 > 6.25 else "")
            seen.add("plain" if printed.oscillation(step.h) is None else "laid over")
    assert seen == {"", "take-off", "landing", "long", "plain", "laid over"}


# --- sections 4 to 7 ----------------------------------------------------------------------------


@pytest.mark.parametrize("name", SLIDERS)
def test_the_printed_residuals_vanish(name):
    """Newton's error is 1e-11 of p and of w, and D is 8 at most."""
    problem, _, taken = walk(name)
    for step in taken:
        found, forces, _ = Printed(problem, step.before).residuals(step.h, step.p, step.w)
        terms = forces + np.abs(D).max() * max(step.before.r, step.p.max())
        assert np.abs(found).max() < 10 * NEWTON * terms


@pytest.mark.parametrize("name", ["damped", "ellipse"])
def test_the_printed_jacobian_is_the_derivative_of_the_residuals(name):
    """(M31) and (M44) to (M46); of differences about a step that is laid over the oscillation."""
    problem, _, taken = walk(name)
    for step in taken[4:8]:
        printed, h = Printed(problem, step.before), step.h
        x = np.concatenate([step.p + 1e-3 * step.p.max(), step.w])
        scale = np.repeat([step.p.max(), 1e-2], 3)
        found = printed.jacobian(h, *x.reshape(2, 3)) * scale
        columns = []
        for each in 1e-5 * np.diag(scale):
            more, less = (printed.residuals(h, *y.reshape(2, 3))[0] for y in (x + each, x - each))
            columns.append((more - less) / 2e-5)
        assert found == pytest.approx(np.transpose(columns), abs=1e-7 * np.abs(found).max())
        more, less = (printed.residuals(h * y, *x.reshape(2, 3))[0] for y in (1 + 1e-5, 1 - 1e-5))
        found = h * printed.by_step_size(h, *x.reshape(2, 3))
        assert found == pytest.approx((more - less) / 2e-5, abs=1e-7 * np.abs(found).max())


@pytest.mark.parametrize("name", SLIDERS)
def test_the_printed_end_of_a_step_is_the_solver_s(name):
    problem, _, taken = walk(name)
    for step in taken:
        u_x, u_y, r, e_x, e_y = Printed(problem, step.before).after(step.h, step.p, step.w)
        after = step.after
        assert after.t == pytest.approx(step.before.t + step.h, rel=1e-14)
        assert (after.u_x, after.u_y) == pytest.approx((u_x, u_y), rel=1e-11)
        assert after.r == pytest.approx(r, rel=1e-12)
        assert (after.e_x, after.e_y) == pytest.approx((e_x, e_y), abs=1e-12)


@pytest.mark.parametrize("w", [-0.7, 0.0, 0.3])
def test_the_friction_along_and_across_is_that_of_the_ellipse(w):
    """(M12) is N s/|M s| in the step's axes, (M16) its derivative."""
    problem, _ = problem_of(ELLIPSE)
    printed = Printed(problem, Motion(0.0, 0.0, 0.0, 1.0, 0.6, 0.8))
    n = problem.surface
    N, s = np.array([[n.xx, n.xy], [n.xy, n.yy]]), printed.e + w * printed.n
    force = N @ s / sqrt(s @ N @ s)
    _, n_1, tau, dtau = printed.friction(1.0, w)
    assert (n_1, tau + w * n_1) == pytest.approx((force @ printed.e, force @ printed.n), rel=1e-13)
    step = 1e-5  # differences: 1e-10, and rounding of 1e-11
    change = printed.friction(1.0, w + step)[2] - printed.friction(1.0, w - step)[2]
    assert dtau == pytest.approx(change / (2 * step), rel=1e-8)


# --- section 5 ----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["damped", "static coefficient"])
def test_the_branch_of_a_take_off(name):
    """(M19) is what a step comes to as its size goes to zero; its error is of the next order."""
    problem, held, taken = walk(name)
    first = next(step for step in taken if step.before.r == 0.0)
    printed = Printed(problem, first.before)
    a_1, a_2, excess, _ = printed.outset()
    assert a_2 == pytest.approx(0.0, abs=1e-9 * a_1)
    excess = excess if name == "static coefficient" else 0.0  # or else rounding
    da_1, da_2 = printed.k @ printed.axes @ printed.v
    c_11, c_12 = printed.c[0]
    slope = problem.law.slope(0.0) * printed.W / printed.m
    off = []
    for h in (1e-7, 1e-8):
        memory = first.state.memory._replace(plan=(h, *first.state.memory.plan[1:]))
        after, _ = turn(problem, held, first.state._replace(memory=memory))
        assert after.memory.h_last == h
        p, w = after.memory.p[3], after.memory.w[3]
        along = excess * h + (da_1 - (c_11 + slope) * excess) * h * h / 2
        across = (da_2 - c_12 * excess) / (a_1 + excess) * h
        off.append([p / along - 1, w / across - 1])
    assert np.abs(off[0]).max() < 0.1
    assert (np.abs(off[1]) < 0.15 * np.abs(off[0]) + 1e-6).all()


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
    assert (f"{weight(0.4):.5f}", f"{weight(0.85):.5f}") == ("0.18830", "0.31714")


@pytest.mark.parametrize("name", SLIDERS)
def test_the_printed_error_estimate_is_the_solver_s(name):
    """Where it is not so small that the solver forgets it.

    A defect is a difference of terms that are rounded; about steady sliding it is held against
    a motion of rounding over the tolerance.
    """
    problem, held, taken = walk(name)
    seen = [step for step in taken if step.error > 0.0]
    assert len(seen) > 5
    for step in seen:
        error = Printed(problem, step.before).error(step.h, step.p, step.w, held)
        assert error / held.tolerance == pytest.approx(step.error, rel=1e-6)


def test_the_local_tolerance():
    """(M39) and (M34)."""
    stretch = next(stretches(DAMPED, 0.0, 1.0))
    for rtol in (1e-2, 1e-6, 1e-10):
        held = accuracy(DAMPED, st.Initial(), stretch, 0.0, rtol)
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
    problem, _, taken = walk(name)
    for step in taken:
        if step.p[2] == 0.0:
            printed = Printed(problem, step.before)
            _, _, z = printed.residuals(step.h, step.p, step.w)
            a_1, a_2 = printed.b(step.h) - printed.k @ z
            f, _, tau, _ = printed.friction(0.0, step.w[2])
            assert a_2 - step.w[2] * a_1 - f * tau == pytest.approx(0.0, abs=1e-9 * abs(a_1))


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
    bound, v_d = next(stretches(s, 0.0, 1.0)).problem.bend, np.array(s.direction)
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
    k, v = np.array([DAMPED.k_x, DAMPED.k_y]), Printed(problem, Motion(0, 0, 0, 0, 1, 0)).v
    times = np.linspace(0.0, tau, 1001)
    held = [np.hypot(*(k * (u + v * t) + [DAMPED.c_x, DAMPED.c_y] * v)) for t in times]
    wanted = np.trapezoid(DAMPED.F_0 - np.array(held), times) / DAMPED.mass
    assert to_spare(problem, 0.0, *u, tau) == pytest.approx(wanted, rel=1e-2)


# --- section 14 ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SLIDERS)
def test_a_sample_is_the_end_of_a_shorter_step(name):
    """Found here by SciPy, from the printed equations."""
    problem, held, taken = walk(name)
    step = max(taken[:10], key=lambda each: each.error if each.p[2] > 0.0 else 0.0)
    nodes, printed = np.array([0.0, *C]), Printed(problem, step.before)
    along = Polynomial.fit(nodes, [step.before.r, *step.p], 3, domain=[0, 1])
    turned = Polynomial.fit(nodes, [0.0, *step.w], 3, domain=[0, 1])
    scale = np.repeat([step.p.max(), np.abs(step.w).max()], 3)
    for part in (0.3, 0.6, 0.95):
        dt = part * step.h
        guess = np.concatenate([along(C * part), turned(C * part)])
        solved = root(
            lambda x, dt=dt: printed.residuals(dt, *(x * scale).reshape(2, 3))[0] / scale,
            guess / scale,
            tol=1e-14,
        )
        p, w = (solved.x * scale).reshape(2, 3)
        u_x, u_y, r, e_x, e_y = printed.after(dt, p, w)
        _, samples = turn(problem, held, step.state, [step.before.t + dt])
        # the time of the sample is rounded
        rounding = 1e-9 * r + 4e-16 * step.before.t * abs(printed.outset()[0])
        assert samples[0, :2] == pytest.approx([u_x, u_y], rel=1e-11)
        assert samples[0, 2:4] == pytest.approx([r * e_x, r * e_y], abs=rounding)


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
    found = np.array(slip_slope(eps, *q)) * 2 * step
    assert found == pytest.approx(wanted, abs=1e-8 * np.abs(wanted).max())


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_a_damped_update(share):
    """(M69), to a thousandth, as iterates need."""
    q, rise = 3.0, 5.0
    up = risen(q, rise, share)
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
def test_the_derivatives_of_a_smoothed_law(slip, surface):
    """Those of (M60), by differences: what is compiled has both from one call."""
    law, load, delta = PAPER.law, 10.0, 1e-6
    smoothed = Smoothed(law, surface, delta)
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


@numba.njit(error_model="numpy")
def eliminated_and_solved(h, k, c, slope, friction, flow, right):
    """Return the solution of (M68) for slip x, slip y and the states, as the solver has it."""
    n = right.shape[0] - 2
    w = workspace(n)
    for i in range(3):
        w.jacobian[i + 1] = flow[i]
        for z in range(2, n + 2):
            w.flow[i + 1, z] = -right[z, i] / h  # all that residuals of states are, at z = z_0
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
    x = linear(h, k[0], c[0], 0.0, (0.0, 0.0, 0.0))
    y = linear(h, k[1], c[1], 0.0, (0.0, 0.0, 0.0))
    m = factors(h, x, y, at, w)
    r_x = right[0, 0], right[0, 1], right[0, 2]
    r_y = right[1, 0], right[1, 1], right[1, 2]
    if n > 0:
        r_x, r_y = residuals_without(h, r_x, r_y, w)
    d_x, d_y = solved(m, r_x, r_y)
    if n > 0:
        correct_states(d_x, d_y, w)
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
    stretch = next(stretches(s, 0.0, 1.0))
    held = accuracy(s, description.initial, stretch, 0.0, 1e-6)._replace(newton=NEWTON)
    method = Smooth(s, None)
    held, state = method.resolved(held), method.begin(description)
    problem = stretch.problem._replace(law=method.flow)
    K, damping = np.array([s.k_x, s.k_y]), np.array([s.c_x, s.c_y])
    v = s.drive.velocity * np.array(s.direction)
    nothing = np.empty(0), np.empty((0, 8)), 0
    for _ in range(30):
        before = state.motion
        _, state, _, _ = smooth_loop.advance(problem, state, 1e9, held, 1, *nothing)
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
    tags = re.findall(r"\\tag\{M(\d+)\}", TEXT)
    assert [int(tag) for tag in tags] == list(range(1, len(tags) + 1))
    for path in (ROOT / "src/stiction").rglob("*.py"):
        cited = re.findall(r"\(M(\d+)\)", path.read_text(encoding="utf-8"))
        assert {int(number) for number in cited} <= set(range(1, len(tags) + 1)), path


def printed_constants():
    """Yield file, name and value of each line of the table in section 17."""
    for line in TEXT.splitlines():
        found = re.match(r"\| ([a-z_/]+\.py) \| ([A-Z_]+) \| (\S+) \|", line)
        if found:
            yield found[1], found[2], float(found[3])


@pytest.mark.parametrize(("file", "name", "value"), list(printed_constants()))
def test_a_printed_constant_is_the_code_s(file, name, value):
    module = importlib.import_module(f"stiction.solver.{file[:-3].replace('/', '.')}")
    assert getattr(module, name) == pytest.approx(value, rel=1e-6)


def test_every_constant_is_printed():
    """Plain numbers with a name of their own; codes of how a run ends are none."""
    printed = {(file, name) for file, name, _ in printed_constants()}
    apart = {"machine_code.py", "refusal.py", "reference.py", "sampling.py", "workspace.py"}
    for path in SOLVER.rglob("*.py"):
        file = path.relative_to(SOLVER).as_posix()
        if path.name in apart:
            continue
        for line in path.read_text(encoding="utf-8").splitlines():
            found = re.match(r"([A-Z_]{3,}(?:, [A-Z_]{3,})*) = ([-\d.e_, ]+)(?: *#.*)?$", line)
            for name in found[1].split(", ") if found and "RUNNING" not in found[1] else ():
                assert (file, name) in printed, "a constant without a name in section 17"
