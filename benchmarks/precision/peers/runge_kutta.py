"""Runge-Kutta with fixed steps, compiled: how the paper solved its equations."""

from __future__ import annotations

import numba
import numpy as np

from benchmarks.harness.contestant import Contestant, rows
from benchmarks.precision.case import PHI, drive, initial_state
from benchmarks.precision.equations import rates

STEPS = ({"dt": 1e-5}, {"dt": 1e-6}, {"dt": 1e-7})  # s


@numba.njit
def _step(u_x, u_y, s_x, s_y, v_x, v_y, dt):
    h = 0.5 * dt
    a = rates(u_x, u_y, s_x, s_y, v_x, v_y, 0.0)
    b = rates(u_x + h * a[0], u_y + h * a[1], s_x + h * a[2], s_y + h * a[3], v_x, v_y, 0.0)
    c = rates(u_x + h * b[0], u_y + h * b[1], s_x + h * b[2], s_y + h * b[3], v_x, v_y, 0.0)
    d = rates(u_x + dt * c[0], u_y + dt * c[1], s_x + dt * c[2], s_y + dt * c[3], v_x, v_y, 0.0)
    sixth = dt / 6.0
    return (
        u_x + sixth * (a[0] + 2.0 * (b[0] + c[0]) + d[0]),
        u_y + sixth * (a[1] + 2.0 * (b[1] + c[1]) + d[1]),
        s_x + sixth * (a[2] + 2.0 * (b[2] + c[2]) + d[2]),
        s_y + sixth * (a[3] + 2.0 * (b[3] + c[3]) + d[3]),
    )


@numba.njit
def _loop(state, v_x, v_y, intervals, steps, dt):
    elongation = np.zeros((intervals + 1, 2))
    u_x, u_y, s_x, s_y = state[0], state[1], state[2], state[3]
    for i in range(1, intervals + 1):
        for _ in range(steps):
            u_x, u_y, s_x, s_y = _step(u_x, u_y, s_x, s_y, v_x, v_y, dt)
        elongation[i, 0] = u_x
        elongation[i, 1] = u_y
    return elongation


def contestants() -> list[Contestant]:
    """The paper's own way: classical Runge-Kutta on its Eqs. (4) and (5), fixed steps."""

    def solve(times, dt, phi=PHI):
        steps = max(1, round((times[1] - times[0]) / dt))
        return _loop(initial_state(phi), *drive(phi), len(times) - 1, steps, dt)

    return rows("RK4, fixed step", solve, STEPS)
