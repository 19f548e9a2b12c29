"""Taylor's method of heyoka: on the regularised law, and from event to event on the exact one."""

from __future__ import annotations

from math import atan2, cos, hypot, sin, sqrt

import numpy as np

from benchmarks.harness.contestant import Contestant, Failed, rows
from benchmarks.precision.case import (
    K_X,
    K_Y,
    MASS,
    MU_0,
    MU_INF,
    PHI,
    V_F,
    W,
    drive,
    initial_state,
)

REGULARISED = (
    {"delta": 1e-6, "tol": 1e-6},
    {"delta": 1e-7, "tol": 1e-5},
    {"delta": 1e-7, "tol": 1e-6},
    {"delta": 1e-8, "tol": 1e-7},
)
EVENTS = ({"tol": 1e-6}, {"tol": 1e-9})  # looser ones lose the landings
STIFFNESS = np.array([K_X, K_Y]) / MASS
HELD = MU_0 * W / MASS  # what friction can hold at zero slip, m/s^2
WEAKENING = (MU_0 - MU_INF) * W / (MASS * V_F)  # how fast it falls with slip, 1/s
TAKE_OFF = 1e-6  # s; the first moment of slip, by its series
SMALL = 1e-9  # m/s; slip that is about to vanish lands in closed form


def contestants() -> list[Contestant]:
    """Return the rows of both ways."""
    return [
        *rows("heyoka, regularised", Regularised().solve, REGULARISED),
        *rows("heyoka, event-driven", EventDriven().solve, EVENTS),
    ]


def friction(hy, speed):
    """Return friction over mass (m/s^2) at a slip speed, an expression of heyoka."""
    return (MU_INF + (MU_0 - MU_INF) * hy.exp(speed * (-1.0 / V_F))) * (W / MASS)


def regularise(hy):
    """Return the system in ``(u_x, u_y, s_x, s_y)`` with parameters ``(v_x, v_y, delta)``."""
    u_x, u_y, s_x, s_y = hy.make_vars("u_x", "u_y", "s_x", "s_y")
    length = hy.sqrt(s_x * s_x + s_y * s_y + hy.par[2] * hy.par[2])
    pull = friction(hy, length) / length
    return [
        (u_x, hy.par[0] - s_x),
        (u_y, hy.par[1] - s_y),
        (s_x, STIFFNESS[0] * u_x - pull * s_x),
        (s_y, STIFFNESS[1] * u_y - pull * s_y),
    ]


class Regularised:
    """The regularised law; integrators are built once for each tolerance."""

    def __init__(self):
        """Import heyoka."""
        import heyoka

        self.hy, self.built = heyoka, {}

    def solve(self, times, *, delta, tol, phi=PHI):
        """Solve at a tolerance, the regularisation being a parameter at run time."""
        if tol not in self.built:
            self.built[tol] = self.hy.taylor_adaptive(regularise(self.hy), np.zeros(4), tol=tol)
        integrator = self.built[tol]
        integrator.time, integrator.pars[:] = 0.0, [*drive(phi), delta]
        integrator.state[:] = initial_state(phi)
        outcome, states = integrator.propagate_grid(times)[::5]
        if outcome != self.hy.taylor_outcome.time_limit:
            raise Failed(str(outcome))
        return np.array(states)[:, :2]


class EventDriven:
    """The exact law: sticks, landings and take-offs in closed form, slip by Taylor's method.

    Slip is in polar form ``(u_x, u_y, r, theta)``, Eqs. (4) and (5) of the paper along and across
    the slip; its end is a terminal event.
    """

    def __init__(self):
        """Import heyoka."""
        import heyoka

        self.hy, self.built = heyoka, {}

    def integrator(self, tol):
        """Return the integrator of slip for a tolerance."""
        hy = self.hy
        if tol not in self.built:
            u_x, u_y, r, theta = hy.make_vars("u_x", "u_y", "r", "theta")
            c, s = hy.cos(theta), hy.sin(theta)
            a_x, a_y = STIFFNESS[0] * u_x, STIFFNESS[1] * u_y
            system = [
                (u_x, hy.par[0] - r * c),
                (u_y, hy.par[1] - r * s),
                (r, a_x * c + a_y * s - friction(hy, r)),
                (theta, (a_y * c - a_x * s) / r),
            ]
            landing = hy.t_event(r - SMALL, direction=hy.event_direction.negative)
            start = np.array([0.0, 0.0, 1.0, 0.0])
            self.built[tol] = hy.taylor_adaptive(system, start, tol=tol, t_events=[landing])
        return self.built[tol]

    def solve(self, times, *, tol, phi=PHI):
        """Solve at a tolerance."""
        integrator, v = self.integrator(tol), np.array(drive(phi))
        integrator.pars[:] = v
        state = initial_state(phi)
        found = np.empty((len(times), 2))
        u, r, theta = state[:2], hypot(*state[2:]), atan2(state[3], state[2])
        t, end, done = 0.0, times[-1], 0
        while True:
            slowing = r <= 1.001 * SMALL
            if slowing and hypot(*(STIFFNESS * u)) < HELD:
                # landing and stick: the spring's end drags the elongation along
                moved = t + landing_time(u, r, theta)
                u = u + v * (moved - t) - 0.5 * r * (moved - t) * np.array([cos(theta), sin(theta)])
                t = moved + holding_time(u, v)
                while done < len(times) and times[done] <= t + TAKE_OFF:
                    found[done] = u + v * (times[done] - moved)
                    done += 1
                if done == len(times):
                    return found
                u = u + v * (t - moved)
                t, u, r, theta = take_off(t, u, v)
            integrator.time = t
            integrator.state[:] = (*u, r, theta)
            # a few samples at a time: the whole rest would be allocated for each slip
            ahead = times[done : done + 8]
            outcome, reached = integrator.propagate_grid(np.array([t, *ahead]))[::5]
            found[done : done + len(reached) - 1] = reached[1:, :2]
            done += len(reached) - 1
            if done == len(times):
                return found
            if outcome == self.hy.taylor_outcome.err_nf_state or integrator.time >= end:
                raise Failed(str(outcome))
            t, (*u, r, theta) = integrator.time, integrator.state
            u = np.array(u)


def landing_time(u, r, theta):
    """Return when slip of speed `r` vanishes, s: the pursuit curve under constant forces."""
    a = STIFFNESS * u
    along = a[0] * cos(theta) + a[1] * sin(theta)
    return r * (HELD + along) / (HELD * HELD - a @ a)


def holding_time(u, v):
    """Return how long friction holds, s: until ``|a + a' t|`` is what it can hold."""
    a, change = STIFFNESS * u, STIFFNESS * v
    square, mixed, rest = change @ change, a @ change, HELD * HELD - a @ a
    root = sqrt(mixed * mixed + square * rest)
    return rest / (mixed + root) if mixed > 0.0 else (root - mixed) / square


def take_off(t, u, v):
    """Return time, elongations, slip speed and angle a moment after a stick, from the series."""
    a, change = STIFFNESS * u, STIFFNESS * v
    e = a / hypot(*a)
    along, across = change @ e, e[0] * change[1] - e[1] * change[0]
    tau = TAKE_OFF
    r = 0.5 * along * tau**2 * (1.0 + WEAKENING * tau / 3.0)
    theta = atan2(e[1], e[0]) + across / HELD * tau
    return t + tau, u + v * tau - r * tau / 3.0 * e, r, theta
