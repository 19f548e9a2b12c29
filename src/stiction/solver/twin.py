"""The exact solver once more, to be read: plain Python, NumPy and SciPy, slow and obvious.

Nothing compiled is used; the two are there to check each other. The motion is a sequence
of phases, each of which starts where the last one ended:

- stick: the slip velocity s is zero, and the spring's end drags the elongation along;
- take-off: the first moment of slip, as a series in time;
- slip: Eqs. (4) and (5) in polar form, integrated by LSODA;
- landing: the last moment of slip, in closed form.

Equation numbers are those of Nakano & Popov, arXiv:2008.01854.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from stiction.drive import ConstantLoad, ConstantVelocity
from stiction.initial import Initial
from stiction.slider import Slider

# slip speed, relative to the motion's own, at which a landing is left to its closed form
VANISHING = 1e-8
# length of a take-off's series, relative to the shorter natural period over 2 pi
TAKE_OFF = 1e-4


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
    """A piece of the motion: when it ends (s), and (u, s) at any time until then."""

    end: float
    motion: Callable[[float], tuple[np.ndarray, np.ndarray]]


class Equations(NamedTuple):
    """Eq. (1) over the mass: m ds/dt = m a - F(|s|) s/|s|, with m a = K u + C du/dt.

    Stiffness K/m (1/s^2), damping C/m (1/s), drive velocity v_d (m/s), all along the axes
    x and y; friction force over mass (m/s^2) and its slope (1/s) as functions of the slip
    speed; a slip speed (m/s) and a rate (1/s) typical of the motion.
    """

    stiffness: np.ndarray
    damping: np.ndarray
    drive: np.ndarray
    friction: Callable[[float], float]
    slope: Callable[[float], float]
    speed: float
    rate: float

    def pull(self, u: np.ndarray, s: np.ndarray) -> np.ndarray:
        """Return a, what spring and damper do to the slip; du/dt = v_d - s, Eq. (2)."""
        return self.stiffness * u + self.damping * (self.drive - s)


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
        Where to give the motion, ascending, s; at the start and the end when left out.
    initial : Initial, optional
        The state to start from; by default the paper's.
    rtol : float, optional
        Local tolerance of the slip phases, relative to the distance slipped and to the slip
        speed (both with a floor where they vanish), and absolute for the direction (rad).

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
    rows, sticks, k = [], [], 0
    while t < end:
        phase = next_phase(equations, t, end, u, s, rtol)
        if phase.end > t and not s.any() and not phase.motion(phase.end)[1].any():
            sticks.append((t, phase.end))
        while k < len(wanted) and wanted[k] <= phase.end:
            rows.append(np.concatenate(phase.motion(wanted[k])))
            k += 1
        t, (u, s) = phase.end, phase.motion(phase.end)
    columns = np.array(rows).reshape(-1, 4).T
    return Twin(wanted[:k], *columns, np.array(sticks).reshape(-1, 2))


def equations_of(slider: Slider) -> Equations:
    """Return the equations of motion of a slider."""
    if not isinstance(slider.drive, ConstantVelocity) or not isinstance(slider.load, ConstantLoad):
        raise ValueError(f"the twin knows a steady drive and load only, not {slider.drive!r}")
    c, s = slider.direction
    drive = slider.drive.velocity * np.array([c, s])
    force, law = slider.load.force / slider.mass, slider.law
    rate = np.sqrt(max(slider.k_x, slider.k_y) / slider.mass)
    speeds = [*np.abs(drive), law.coefficient(0.0) * force / rate]
    return Equations(
        np.array([slider.k_x, slider.k_y]) / slider.mass,
        np.array([slider.c_x, slider.c_y]) / slider.mass,
        drive,
        lambda v: law.coefficient(v) * force,
        lambda v: law.slope(v) * force,
        min(speed for speed in speeds if speed > 0.0),
        rate,
    )


def next_phase(
    equations: Equations, t: float, end: float, u: np.ndarray, s: np.ndarray, rtol: float
) -> Phase:
    """Return the phase that begins at `t`: at zero slip, friction decides between two."""
    r = float(np.hypot(*s))
    growing = equations.pull(u, s) @ s > equations.friction(r) * r
    if r > 2 * VANISHING * equations.speed or growing:
        return slip(equations, t, end, u, s, rtol)
    if r > 0.0:
        return landing(equations, t, end, u, s)
    duration = time_held(equations, u)
    if duration > 0.0:
        return stick(equations, t, min(t + duration, end), u)
    return take_off(equations, t, end, u)


def time_held(equations: Equations, u: np.ndarray) -> float:
    """Return how long friction holds the mass: until |a| reaches mu_0 W/m (s).

    While s = 0, a grows steadily: a = a_0 + a' tau, a' = K v_d/m, and |a|^2 = f^2 is a
    quadratic in tau. It ends at the root at which |a| grows. (A root within rounding of
    zero is no stick: that is where the last one ended.)
    """
    still = np.zeros(2)
    a, change = equations.pull(u, still), equations.stiffness * equations.drive
    f = equations.friction(0.0)
    excess = a @ a - f * f
    if excess > 1e-13 * f * f or (excess > -1e-13 * f * f and a @ change > 0.0):
        return 0.0
    if not change.any():
        return np.inf
    return float(max(np.roots([change @ change, 2 * a @ change, excess]).real))


def stick(equations: Equations, t: float, end: float, u: np.ndarray) -> Phase:
    """Stick: du/dt = v_d, Eq. (2) at zero slip."""
    return Phase(end, lambda at: (u + equations.drive * (at - t), np.zeros(2)))


def take_off(equations: Equations, t: float, end: float, u: np.ndarray) -> Phase:
    """Take-off: the slip starts along a and turns with it, p' = |a| - F(p)/m.

    From p = 0 this gives p = p' tau + p'' tau^2/2, p' = |a| - f, p'' = d|a|/dt - (F'/m) p'.
    After a stick |a| = f, and p = (1/2) d|a|/dt tau^2. The error, of order tau^3, is below
    1e-12 of the motion's own slip speed for `TAKE_OFF` = 1e-4.
    """
    a = equations.pull(u, np.zeros(2))
    size = float(np.hypot(*a))
    e = a / size
    first = max(0.0, size - equations.friction(0.0))
    if first < 1e-9 * size:
        first = 0.0
    change = equations.stiffness * equations.drive - equations.damping * first * e
    second = change @ e - equations.slope(0.0) * first

    def motion(at: float) -> tuple[np.ndarray, np.ndarray]:
        tau = at - t
        direction = a + change * tau
        p = first * tau + second * tau**2 / 2
        slid = first * tau**2 / 2 + second * tau**3 / 6
        return u + equations.drive * tau - slid * e, p * direction / np.hypot(*direction)

    return Phase(min(t + TAKE_OFF / equations.rate, end), motion)


def slip(
    equations: Equations, t: float, end: float, u: np.ndarray, s: np.ndarray, rtol: float
) -> Phase:
    """Slip: Eqs. (4) and (5) with s = r (cos theta, sin theta), until r almost vanishes.

        dr/dt = a . (cos theta, sin theta) - F(r)/m
        r dtheta/dt = a . (-sin theta, cos theta)

    Friction slows the slip down but cannot turn it. The direction follows a at the rate
    |a|/r, without bound as r vanishes; hence a clock that ticks with the slip, dt = r dn.
    Beside time, r and theta, the distance slid since the phase began is integrated: u, which
    is what the drive has pulled less what has been slid, hardly changes in a phase, and a
    tolerance relative to it would not see the transverse motion.
    """

    def motion_of(y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        elapsed, slid, r, theta = y[0], y[1:3], y[3], y[4]
        e = np.array([np.cos(theta), np.sin(theta)])
        return u + equations.drive * elapsed - slid, r * e

    def change(_: float, y: np.ndarray) -> np.ndarray:
        now_u, now_s = motion_of(y)
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
        method=METHOD,
        events=(vanishing, over),
        dense_output=True,
        rtol=rtol,
        atol=rtol * np.array([1e-3 / equations.rate, distance, distance, equations.speed, 1.0]),
    )
    if not solution.success:
        raise ArithmeticError(f"after t = {t:g} s: {solution.message}")
    global NFEV
    NFEV += solution.nfev
    last = solution.t[-1]

    def motion(at: float) -> tuple[np.ndarray, np.ndarray]:
        elapsed = at - t
        if elapsed >= solution.y[0, -1]:
            return motion_of(solution.y[:, -1])
        n = brentq(lambda n: solution.sol(n)[0] - elapsed, 0.0, last, xtol=1e-300, rtol=1e-15)
        return motion_of(solution.sol(n))

    return Phase(end if solution.t_events[1].size else t + float(solution.y[0, -1]), motion)


METHOD = "LSODA"
NFEV = 0


def landing(equations: Equations, t: float, end: float, u: np.ndarray, s: np.ndarray) -> Phase:
    """Landing: s' = a - f s/|s| with constant a and f, the classical pursuit curve.

    From d/dt (f r + a.s) = |a|^2 - f^2 zero slip follows after r (f + a.e)/(f^2 - |a|^2),
    e = s/r. `VANISHING` is so small that what is slid meanwhile, about r/2 times that
    time, matters to nobody.
    """
    a, f, r = equations.pull(u, s), equations.friction(0.0), np.hypot(*s)
    along, size = a @ s / r, np.hypot(*a)
    if size >= f and abs(along) < size * (1 - 1e-12):
        raise ArithmeticError(f"at t = {t:g} s the slip turns round without ever vanishing")
    # straight back and forth: the same expression, with f + a.e cancelled against f - |a|
    duration = r / (f - along) if size >= f else r * (f + along) / (f * f - size * size)

    def motion(at: float) -> tuple[np.ndarray, np.ndarray]:
        x = 1.0 if at >= t + duration else (at - t) / duration
        slid = s * (x - x * x / 2) * duration
        return u + equations.drive * (at - t) - slid, s * (1 - x)

    return Phase(min(t + duration, end), motion)
