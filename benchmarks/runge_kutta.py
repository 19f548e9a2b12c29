"""Runge-Kutta with fixed steps, compiled: how the paper solved its equations."""

from __future__ import annotations

from functools import partial

import numba
import numpy as np

from .contestant import Contestant, on_times
from .problem import initial_state, rates

STEPS = (1e-6, 1e-7)  # s


@numba.njit
def _step(u_x, u_y, s_x, s_y, dt):
    a = rates(u_x, u_y, s_x, s_y, 0.0)
    h = 0.5 * dt
    b = rates(u_x + h * a[0], u_y + h * a[1], s_x + h * a[2], s_y + h * a[3], 0.0)
    c = rates(u_x + h * b[0], u_y + h * b[1], s_x + h * b[2], s_y + h * b[3], 0.0)
    d = rates(u_x + dt * c[0], u_y + dt * c[1], s_x + dt * c[2], s_y + dt * c[3], 0.0)
    sixth = dt / 6.0
    return (
        u_x + sixth * (a[0] + 2.0 * (b[0] + c[0]) + d[0]),
        u_y + sixth * (a[1] + 2.0 * (b[1] + c[1]) + d[1]),
        s_x + sixth * (a[2] + 2.0 * (b[2] + c[2]) + d[2]),
        s_y + sixth * (a[3] + 2.0 * (b[3] + c[3]) + d[3]),
    )


@numba.njit
def _loop(state, intervals, steps, dt):
    elongation = np.zeros((intervals + 1, 2))
    u_x, u_y, s_x, s_y = state[0], state[1], state[2], state[3]
    for i in range(1, intervals + 1):
        for _ in range(steps):
            u_x, u_y, s_x, s_y = _step(u_x, u_y, s_x, s_y, dt)
        elongation[i, 0] = u_x
        elongation[i, 1] = u_y
    return elongation


def fixed_step() -> list[Contestant]:
    """The paper's own way: classical Runge-Kutta on its Eqs. (4) and (5), fixed steps."""

    def solve(times, dt):
        steps = round((times[1] - times[0]) / dt)
        return _loop(initial_state(), len(times) - 1, steps, dt)

    return [on_times("RK4, fixed step", f"dt={dt:g} s", partial(solve, dt=dt)) for dt in STEPS]
