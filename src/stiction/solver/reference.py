"""A readable reference of the exact solver: plain Python, NumPy and SciPy, slow and obvious.

It uses no compiled code; the two solvers check each other. The motion is a sequence of phases,
each of which starts where the last one ended:

- stick: the slip velocity s is zero, and the spring's end drags the elongation along;
- take-off: the first moment of slip, by successive approximation;
- slip: Eqs. (4) and (5) in polar form, by an explicit Runge-Kutta method;
- landing: the last moment of slip, in closed form.

Equation numbers are those of Nakano & Popov, arXiv:2008.01854.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev
from scipy.integrate import solve_ivp  # type: ignore[attr-defined]
from scipy.optimize import brentq

from stiction.drive import ConstantVelocity
from stiction.system.initial import Initial
from stiction.system.slider import Slider
from stiction.system.tensors import is_aligned

TAKE_OFF = 0.1  # length of a take-off, in units of the shorter natural period over 2 pi
DEGREE = 8  # of the polynomials in time that describe it; their error is near rounding
VANISHING = 1e-10  # slip speed at the start of a landing, relative to the motion's own

State = tuple[np.ndarray, np.ndarray]  # elongation u (m) and slip velocity s (m/s)


class Twin(NamedTuple):
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
    """Eq. (1) over the mass: ds/dt = a - F(|s|)/m s/|s|, with a = (K u + C du/dt)/m.

    Stiffness K/m (1/s^2), damping C/m (1/s) and drive velocity v_d (m/s) along x and y;
    friction force over mass (m/s^2) as a function of the slip speed (m/s); a slip speed
    (m/s) and a rate (1/s) typical of the motion, for tolerances.
    """

    stiffness: np.ndarray
    damping: np.ndarray
    drive: np.ndarray
    friction: Callable[[float], float]
    speed: float
    rate: float

    def pull(self, u: np.ndarray, s: np.ndarray) -> np.ndarray:
        """Return the acceleration a of slip (m/s^2), Eq. (1), with du/dt = v_d - s, Eq. (2)."""
        a: np.ndarray = self.stiffness * u + self.damping * (self.drive - s)
        return a


def twin(
    slider: Slider,
    duration: float,
    times: np.ndarray | None = None,
    *,
    initial: Initial | None = None,
    rtol: float = 1e-10,
) -> Twin:
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
    return Twin(wanted[: len(rows)], u_x, u_y, slip_x, slip_y, intervals)


def equations_of(slider: Slider) -> Equations:
    """Return the equations of motion of a slider."""
    if not isinstance(slider.drive, ConstantVelocity) or slider.load is not None:
        raise ValueError(f"the twin knows a steady drive and load only, not {slider.drive!r}")
    if not is_aligned(slider):
        raise ValueError("the twin knows one mass and dampers along the springs only")
    drive = slider.drive.velocity * np.array(slider.direction)
    force, law = slider.normal_load / slider.mass, slider.law
    stiffness = np.array([slider.k_x, slider.k_y]) / slider.mass
    rate = float(np.sqrt(stiffness.max()))
    speeds = [*np.abs(drive), law.coefficient(0.0) * force / rate]
    return Equations(
        stiffness,
        np.array([slider.c_x, slider.c_y]) / slider.mass,
        drive,
        lambda v: law.coefficient(v) * force,
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
    growing = equations.pull(u, s) @ s > equations.friction(r) * r
    if r > 2 * VANISHING * equations.speed or growing:
        return slip(equations, t, end, u, s, rtol)
    return landing(equations, t, end, u, s)


def time_held(equations: Equations, u: np.ndarray) -> float:
    """Return the time (s) that friction holds the mass: until |a| reaches f = mu_0 W/m.

    While s = 0, a changes at the constant rate a' = K v_d/m, and |a + a' tau|^2 = f^2 is quadratic
    in tau; the stick ends at the root at which |a| grows. If |a| equals f within rounding and
    grows, the stick has just ended.
    """
    a, change = equations.pull(u, np.zeros(2)), equations.stiffness * equations.drive
    f = equations.friction(0.0)
    excess = a @ a - f * f
    rounding = 1e-13 * f * f
    if excess > rounding or (excess > -rounding and a @ change > 0.0):
        return 0.0
    if not change.any():
        return np.inf
    return float(max(np.roots([change @ change, 2 * a @ change, excess]).real))


def stick(equations: Equations, t: float, end: float, u: np.ndarray) -> Phase:
    """Stick: du/dt = v_d, Eq. (2) at zero slip."""
    return Phase(end, lambda at: (u + equations.drive * (at - t), np.zeros(2)))


def take_off(equations: Equations, t: float, end: float, u: np.ndarray, part: float = 1.0) -> Phase:
    """Take-off: slip begins along the force that held, and turns with it.

    In axes along and across a(0) the slip velocity is written p (1, w); then Eqs. (4) and
    (5) read p' = a_1 - F(|s|)/m/sqrt(1 + w^2), p w' = a_2 - w a_1, which is regular at
    p = 0. Starting from p = w = 0, each pass computes a from the distance slid, solves the second
    equation for w (it is linear), and integrates the first for p, at the nodes of a Chebyshev
    polynomial in time. After a stick p begins as d|a|/dt tau^2/2; if the force exceeds the friction
    limit, as (|a| - f) tau. If the polynomial is not accurate, because friction changes fast, half
    the length is tried.
    """
    length = min(t + part * TAKE_OFF / equations.rate, end) - t
    e = equations.pull(u, np.zeros(2))
    e /= np.hypot(*e)
    across = np.array([-e[1], e[0]])
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
        a = equations.pull(u + np.outer(time, equations.drive) - gone, s)
        w = np.linalg.solve(p[:, None] * derivative + np.diag(a @ e), a @ across)
        stretch = np.sqrt(1 + w * w)
        friction = np.array([equations.friction(v) for v in np.abs(p) * stretch])
        before, p = p, slid(a @ e - friction / stretch)
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

        dr/dt = a . (cos theta, sin theta) - F(r)/m
        r dtheta/dt = a . (-sin theta, cos theta)

    Friction slows the slip down but cannot turn it. The direction follows a at the rate |a|/r,
    which is unbounded as r vanishes. Hence the independent variable n with dt = r dn, and steps of
    at most a few m/F in n: with longer ones an explicit method becomes noisy. The tolerance is
    relative for the elapsed time, the distance slid in the phase (u hardly changes) and the slip
    speed, with a floor, and absolute for the direction.
    """

    def state_of(y: np.ndarray) -> State:
        elapsed, slid, r, theta = y[0], y[1:3], y[3], y[4]
        e = np.array([np.cos(theta), np.sin(theta)])
        return u + equations.drive * elapsed - slid, r * e

    def change(_: float, y: np.ndarray) -> np.ndarray:
        now_u, now_s = state_of(y)
        a, r, e = equations.pull(now_u, now_s), y[3], now_s / y[3]
        along, across = a @ e, e[0] * a[1] - e[1] * a[0]
        return np.array([r, *(r * now_s), r * (along - equations.friction(r)), across])

    def vanishing(_: float, y: np.ndarray) -> float:
        return float(y[3] / (VANISHING * equations.speed) - 1)

    def over(_: float, y: np.ndarray) -> float:
        return float(y[0] - (end - t))

    vanishing.terminal, vanishing.direction = True, -1  # type: ignore[attr-defined]
    over.terminal = True  # type: ignore[attr-defined]
    distance = equations.speed / equations.rate
    solution = solve_ivp(
        change,
        (0.0, np.inf),
        [0.0, 0.0, 0.0, np.hypot(*s), np.arctan2(s[1], s[0])],
        method="DOP853",
        events=(vanishing, over),
        dense_output=True,
        max_step=3.0 / equations.friction(0.0),
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
    """Landing: s' = a - f s/|s| with constant a and f, the classical pursuit curve.

    From d/dt (f r + a.s) = |a|^2 - f^2 zero slip follows after r (f + a.e)/(f^2 - |a|^2), e = s/r.
    If f is smaller than |a|, the slip was (nearly) opposite to a, because otherwise it would not
    have vanished, and the time is r/(f + |a|). The distance slid until then, about r/2 times this
    time, is below rounding.
    """
    a, f, r = equations.pull(u, s), equations.friction(0.0), float(np.hypot(*s))
    size = float(np.hypot(*a))
    duration = r * (f + a @ s / r) / (f * f - size * size) if size < f else r / (f + size)

    def state(at: float) -> State:
        x = 1.0 if at >= t + duration else (at - t) / duration
        slid = s * (x - x * x / 2) * duration
        return u + equations.drive * (at - t) - slid, s * (1 - x)

    return Phase(min(t + duration, end), state)
