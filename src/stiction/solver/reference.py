"""A reference to read, and to check the exact solver by: plain Python, NumPy and SciPy, slow.

No simulation runs it. Readers find the method here without what makes it fast; tests and benchmarks
compare the compiled solver with it, of which it uses nothing. The motion is a sequence of phases,
each of which starts where the last one ended:

- stick: the slip velocity s is zero, and the spring's end drags the elongation along;
- take-off: the first moment of slip, by successive approximation;
- slip: Eqs. (4) and (5) in polar form, by an explicit Runge-Kutta method;
- landing: the last moment of slip, in closed form where friction and mass are the same all around.

Any planar rig is taken as it is, with its tensors in the axes x and y: the coordinates (M71) of the
compiled solver, weighted by mass, do not occur here.

Equation numbers are those of Nakano & Popov, arXiv:2008.01854.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin, sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from stiction.drive import ConstantVelocity
from stiction.friction import Anisotropic
from stiction.system.initial import Initial
from stiction.system.slider import Slider
from stiction.system.tensors import (
    damping_tensor,
    mobility_tensor,
    stiffness_tensor,
    surface_tensor,
)

TAKE_OFF = 0.1  # length of a take-off, in units of the shorter natural period over 2 pi
DEGREE = 8  # of the polynomials in time that describe it; their error is near rounding
NUDGE = 1e-4  # of w, for a slope by a difference; it changes the way to w, not w
VANISHING = 1e-10  # slip speed at the start of a landing, relative to the motion's own

State = tuple[np.ndarray, np.ndarray]  # elongation u (m) and slip velocity s (m/s)


class ReferenceRun(NamedTuple):
    """Elongation (m) and slip velocity (m/s) at the times `t` (s), and the stick intervals.

    `sticks` (n, 2): start and end of each (s).
    """

    t: np.ndarray
    u_x: np.ndarray
    u_y: np.ndarray
    slip_x: np.ndarray
    slip_y: np.ndarray
    sticks: np.ndarray


class Phase(NamedTuple):
    """A piece of the motion: its end (s), and a function that returns the state until then."""

    end: float
    state: Callable[[float], State]


class Equations(NamedTuple):
    """Eq. (1): M ds/dt = g - F(|s|) n(s), with g = K u + C du/dt and n = N s/sqrt(s.N s).

    The inverse of M (1/kg), K (N/m), C (N s/m) and N as matrices in the axes x and y, and the drive
    velocity v_d (m/s) there; friction force (N) as a function of the slip speed (m/s); a slip
    speed (m/s) and a rate (1/s) typical of the motion, for tolerances.
    """

    mobility: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    surface: np.ndarray
    drive: np.ndarray
    friction: Callable[[float], float]
    speed: float
    rate: float

    def pull(self, u: np.ndarray, s: np.ndarray) -> np.ndarray:
        """Return the force g (N) that pulls, Eq. (1), with du/dt = v_d - s, Eq. (2)."""
        g: np.ndarray = u @ self.stiffness + (self.drive - s) @ self.damping
        return g

    def toward(self, s: np.ndarray) -> np.ndarray:
        """Return n(s): friction over F, which for an isotropic surface is the unit vector of s."""
        size = np.sqrt(np.sum(s * (s @ self.surface), axis=-1, keepdims=True))
        n: np.ndarray = s @ self.surface / size
        return n

    def acceleration(self, g: np.ndarray, s: np.ndarray, friction: Any) -> np.ndarray:
        """Return ds/dt (m/s^2) under the forces g and friction, of slips in a direction s."""
        a: np.ndarray = (g - friction * self.toward(s)) @ self.mobility
        return a

    def use(self, g: np.ndarray, other: np.ndarray) -> float:
        """Return g.N^-1 other; g.N^-1 g = F^2 is the friction limit."""
        return float(g @ np.linalg.solve(self.surface, other))

    @property
    def uniform(self) -> bool:
        """Whether friction and mass are the same in all directions."""
        return all(np.array_equal(A, A[0, 0] * np.eye(2)) for A in (self.mobility, self.surface))


def reference_run(
    slider: Slider,
    duration: float,
    times: np.ndarray | None = None,
    *,
    initial: Initial | None = None,
    rtol: float = 1e-10,
) -> ReferenceRun:
    """Integrate a slider with a steady drive and load; friction at zero slip is set-valued.

    Parameters
    ----------
    slider : Slider
        The system.
    duration : float
        s.
    times : ndarray, optional
        Output times, ascending, s; by default start and end.
    initial : Initial, optional
        The state to start from; by default the paper's.
    rtol : float, optional
        Local tolerance of the slip phases; see `exact.collocation`.

    Raises
    ------
    ValueError
        If the drive or the load changes in time.
    """
    initial = initial or Initial()
    equations = equations_of(slider)
    t, end = initial.time, initial.time + duration
    u, s = np.array([initial.u_x, initial.u_y]), np.array(initial.slip(slider))
    wanted = np.array([t, end]) if times is None else np.asarray(times, dtype=np.float64)
    rows: list[np.ndarray] = []
    sticks = []
    while t < end:
        phase = next_phase(equations, t, end, u, s, rtol)
        u, s, held = *phase.state(phase.end), not s.any()
        if held and not s.any():
            sticks.append((t, phase.end))
        rows += [np.concatenate(phase.state(at)) for at in wanted[len(rows) :] if at <= phase.end]
        t = phase.end
    u_x, u_y, slip_x, slip_y = np.array(rows).reshape(-1, 4).T
    intervals = np.array(sticks).reshape(-1, 2)
    return ReferenceRun(wanted[: len(rows)], u_x, u_y, slip_x, slip_y, intervals)


def equations_of(slider: Slider) -> Equations:
    """Return the equations of motion of a slider."""
    if not isinstance(slider.drive, ConstantVelocity) or slider.load is not None:
        raise ValueError(f"the reference knows a steady drive and load only, not {slider.drive!r}")
    drive = slider.drive.velocity * np.array(slider.direction)
    law: Any = slider.law
    surface = surface_tensor(slider)
    if isinstance(law, Anisotropic):
        law = law.law
    mobility, stiffness = mobility_tensor(slider), stiffness_tensor(slider)
    rate = float(np.sqrt(np.linalg.eigvals(mobility @ stiffness).real.max()))
    limit = law.coefficient(0.0) * slider.normal_load
    speeds = [*np.abs(drive), limit * np.linalg.eigvalsh(mobility).max() / rate]
    return Equations(
        mobility,
        stiffness,
        damping_tensor(slider),
        surface,
        drive,
        lambda v: law.coefficient(v) * slider.normal_load,
        min(speed for speed in speeds if speed > 0.0),
        rate,
    )


def next_phase(
    equations: Equations, t: float, end: float, u: np.ndarray, s: np.ndarray, rtol: float
) -> Phase:
    """Return the phase that begins at `t` with the state (u, s)."""
    r = float(np.hypot(*s))
    if r == 0.0:
        held = time_held(equations, u)
        if held > 0.0:
            return stick(equations, t, min(t + held, end), u)
        return take_off(equations, t, end, u)
    change = equations.acceleration(equations.pull(u, s), s, equations.friction(r))
    growing = change @ s > 0.0
    if r > 2 * VANISHING * equations.speed or growing:
        return slip(equations, t, end, u, s, rtol)
    return landing(equations, t, end, u, s)


def time_held(equations: Equations, u: np.ndarray) -> float:
    """Return the time (s) that friction holds the mass: until g.N^-1 g reaches F_0^2, (M6).

    While s = 0, g changes at the constant rate g' = K v_d, so that this is quadratic in time; the
    stick ends at the root at which it grows. If it is reached within rounding and grows, the stick
    has just ended.
    """
    g, change = equations.pull(u, np.zeros(2)), equations.drive @ equations.stiffness
    F_0 = equations.friction(0.0)
    excess, growth = equations.use(g, g) - F_0 * F_0, equations.use(g, change)
    rounding = 1e-13 * F_0 * F_0
    if excess > rounding or (excess > -rounding and growth > 0.0):
        return 0.0
    if not change.any():
        return np.inf
    return float(max(np.roots([equations.use(change, change), 2 * growth, excess]).real))


def stick(equations: Equations, t: float, end: float, u: np.ndarray) -> Phase:
    """Stick: du/dt = v_d, Eq. (2) at zero slip."""
    return Phase(end, lambda at: (u + equations.drive * (at - t), np.zeros(2)))


def first_direction(equations: Equations, g: np.ndarray) -> np.ndarray:
    """Return the unit vector along which slip begins under a force at the friction limit or beyond.

    At the limit it is that of the slip whose friction g would be, n(s) = g/F_0. Beyond, the mass
    accelerates along its slip: ds/dt is parallel to s.
    """
    e: np.ndarray = np.linalg.solve(equations.surface, g)
    e /= np.hypot(*e)
    F_0 = equations.friction(0.0)
    if equations.use(g, g) <= F_0 * F_0 * (1.0 + 1e-13):
        return e

    def across(angle: float) -> float:
        c, s = np.cos(angle), np.sin(angle)
        turned = np.array([c * e[0] - s * e[1], s * e[0] + c * e[1]])
        a = equations.acceleration(g, turned, F_0)
        return float(turned[0] * a[1] - turned[1] * a[0])

    search: Any = brentq  # its stubs are missing
    angles = np.linspace(-np.pi / 2, np.pi / 2, 181)
    values = [across(angle) for angle in angles]
    falls = [k for k in range(180) if values[k] > 0.0 >= values[k + 1]]
    k = min(falls, key=lambda k: abs(angles[k])) if falls else 90
    angle = search(across, angles[k], angles[k + 1], xtol=1e-15) if falls else 0.0
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * e[0] - s * e[1], s * e[0] + c * e[1]])


def take_off(equations: Equations, t: float, end: float, u: np.ndarray, part: float = 1.0) -> Phase:
    """Take-off: slip begins along `first_direction`, and turns with the force.

    In axes along and across that direction the slip velocity is written p (1, w). With the
    acceleration R = M^-1 (g - F n) along both, Eqs. (4) and (5) read p' = R_1 and p w' = R_2 -
    w R_1 = G(w), which is regular at p = 0. Starting from p = w = 0, each pass computes g from the
    distance slid, solves the second equation for w, linearised about the last one, and integrates
    the first for p, at the nodes of a Chebyshev polynomial in time. If the polynomial is not
    accurate, because friction changes fast, half the length is tried.
    """
    length = min(t + part * TAKE_OFF / equations.rate, end) - t
    e = first_direction(equations, equations.pull(u, np.zeros(2)))
    across = np.array([-e[1], e[0]])
    axes = np.array([e, across]).T
    time = length * (1 - np.cos(np.pi * np.arange(DEGREE + 1) / DEGREE)) / 2

    def through(values: np.ndarray) -> Chebyshev:
        return Chebyshev.fit(time, values, DEGREE, domain=[0.0, length])

    def slid(values: np.ndarray) -> np.ndarray:
        return np.asarray(through(values).integ(lbnd=0.0)(time))

    derivative = np.array([through(row).deriv()(time) for row in np.eye(DEGREE + 1)]).T
    p = w = np.zeros(DEGREE + 1)
    for _ in range(50):
        s = np.outer(p, e) + np.outer(p * w, across)
        gone = np.outer(slid(p), e) + np.outer(slid(p * w), across)
        g = equations.pull(u + np.outer(time, equations.drive) - gone, s)
        friction = np.array([equations.friction(v) for v in np.abs(p) * np.hypot(1.0, w)])[:, None]

        def turns(
            w: np.ndarray, g: np.ndarray = g, friction: np.ndarray = friction
        ) -> tuple[np.ndarray, np.ndarray]:
            """Return R_1 and G at the nodes."""
            R = equations.acceleration(g, e + np.outer(w, across), friction) @ axes
            return R[:, 0], R[:, 1] - w * R[:, 0]

        G, slope = turns(w)[1], (turns(w + NUDGE)[1] - turns(w - NUDGE)[1]) / (2 * NUDGE)
        w = np.linalg.solve(p[:, None] * derivative - np.diag(slope), G - slope * w)
        before, p = p, slid(turns(w)[0])
        change = np.abs(p - before).max()
        if change <= 1e-11 * np.abs(p).max():
            break
    along, sideways = through(p), through(p * w)
    if max(change, *np.abs(along.coef[-2:])) > 1e-10 * np.abs(p).max():
        if part < 1e-6:
            raise ArithmeticError(f"the take-off at t = {t:g} s is not found")
        return take_off(equations, t, end, u, part / 2)

    def state(at: float) -> State:
        tau = at - t
        distance = along.integ(lbnd=0.0)(tau) * e + sideways.integ(lbnd=0.0)(tau) * across
        return u + equations.drive * tau - distance, along(tau) * e + sideways(tau) * across

    return Phase(t + length, state)


def slip(
    equations: Equations, t: float, end: float, u: np.ndarray, s: np.ndarray, rtol: float
) -> Phase:
    """Slip: Eqs. (4) and (5) with s = r (cos theta, sin theta), until r almost vanishes.

        dr/dt = R . (cos theta, sin theta)
        r dtheta/dt = R . (-sin theta, cos theta),    R = M^-1 (g - F(r) n)

    The direction changes at the rate |R|/r, which is unbounded as r vanishes. Hence the independent
    variable n with dt = r dn, and steps of at most a few m/F in n: with longer ones an explicit
    method becomes noisy. The tolerance is
    relative for the elapsed time, the distance slid in the phase (u hardly changes) and the slip
    speed, with a floor, and absolute for the direction.
    """

    def state_of(y: np.ndarray) -> State:
        elapsed, slid, r, theta = y[0], y[1:3], y[3], y[4]
        e = np.array([np.cos(theta), np.sin(theta)])
        return u + equations.drive * elapsed - slid, r * e

    K, C, N = equations.stiffness, equations.damping, equations.surface
    (N_xx, N_xy), (_, N_yy) = N.tolist()
    at_first = equations.pull(u, np.zeros(2))
    # R = M^-1 (g - F n) is linear in 1, the elapsed time, the distance slid, s, and F over |e|_N
    linear = np.vstack([at_first, equations.drive @ K, -K, -C, -N]) @ equations.mobility

    def change(_: float, y: np.ndarray) -> list[float]:
        elapsed, slid_x, slid_y, r, theta = y.tolist()
        c, s = cos(theta), sin(theta)
        F = equations.friction(r) / sqrt(c * (N_xx * c + 2.0 * N_xy * s) + N_yy * s * s)
        variables = [1.0, elapsed, slid_x, slid_y, r * c, r * s, F * c, F * s]
        R_x, R_y = (np.array(variables) @ linear).tolist()
        return [r, r * r * c, r * r * s, r * (R_x * c + R_y * s), c * R_y - s * R_x]

    def vanishing(_: float, y: np.ndarray) -> float:
        return float(y[3] / (VANISHING * equations.speed) - 1)

    def over(_: float, y: np.ndarray) -> float:
        return float(y[0] - (end - t))

    vanishing.terminal, vanishing.direction = True, -1  # type: ignore[attr-defined]
    over.terminal = True  # type: ignore[attr-defined]
    distance = equations.speed / equations.rate
    hardest = float(np.sqrt(np.linalg.eigvalsh(equations.surface).max()))
    quickest = equations.friction(0.0) * hardest * np.linalg.eigvalsh(equations.mobility).max()
    solution = solve_ivp(
        change,
        (0.0, np.inf),
        [0.0, 0.0, 0.0, np.hypot(*s), np.arctan2(s[1], s[0])],
        method="DOP853",
        events=(vanishing, over),
        dense_output=True,
        max_step=3.0 / quickest,
        rtol=rtol,
        atol=rtol * np.array([1e-3 / equations.rate, distance, distance, equations.speed, 1.0]),
    )
    if not solution.success:
        raise ArithmeticError(f"after t = {t:g} s: {solution.message}")
    last, y = solution.t[-1], solution.y[:, -1]

    def state(at: float) -> State:
        if at - t >= y[0]:
            return state_of(y)
        clock: Any = brentq  # its stubs are missing
        return state_of(solution.sol(clock(lambda n: solution.sol(n)[0] - at + t, 0.0, last)))

    return Phase(end if solution.t_events[1].size else t + float(y[0]), state)


def landing(equations: Equations, t: float, end: float, u: np.ndarray, s: np.ndarray) -> Phase:
    """Landing: slip under constant forces, so short that the distance slid is below rounding.

    With one mass and isotropic friction it is the classical pursuit curve s' = a - f s/|s|. From
    d/dt (f r + a.s) = |a|^2 - f^2 zero slip follows after r (f + a.e)/(f^2 - |a|^2), e = s/r. If f
    is smaller than |a|, the slip was (nearly) opposite to a, because otherwise it would not have
    vanished, and the time is r/(f + |a|). Otherwise the direction has settled by now, as r has
    fallen by many decades, and r falls at a constant rate.
    """
    g, F_0, r = equations.pull(u, s), equations.friction(0.0), float(np.hypot(*s))
    if equations.uniform:
        a, f = g * equations.mobility[0, 0], F_0 * equations.mobility[0, 0]
        size = float(np.hypot(*a))
        duration = r * (f + a @ s / r) / (f * f - size * size) if size < f else r / (f + size)
    else:
        duration = -r * r / float(equations.acceleration(g, s, F_0) @ s)

    def state(at: float) -> State:
        x = 1.0 if at >= t + duration else (at - t) / duration
        slid = s * (x - x * x / 2) * duration
        return u + equations.drive * (at - t) - slid, s * (1 - x)

    return Phase(min(t + duration, end), state)
