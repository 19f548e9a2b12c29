"""The case that every solver is given: Fig. 3 of Nakano & Popov, 5 s of it.

The peers integrate the state ``(u_x, u_y, s_x, s_y)``: elongations (m) and slip velocity (m/s),
``s = v_d - du/dt``. The elongation rates would do as well on paper, but slip is what the friction
depends on and what is small: with it as the state, LSODA passes tolerances at which it fails with
the rates (and takes the same time where both work).
"""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray

DURATION = 5.0
GRID = np.linspace(0.0, DURATION, 5001)  # s; where solutions are compared
ENDS = np.array([0.0, DURATION])  # s; for runs that are only timed

MASS = 0.25  # kg
K_X = 1e3  # N/m
K_Y = 1e7  # N/m
PHI = math.radians(1.0)
MU_0 = 0.20
MU_INF = 0.15
V_F = 1e-2  # m/s
W = 10.0  # N
V = 1e-3  # m/s
EPSILON = 1e-6

V_X = V * math.cos(PHI)
V_Y = V * math.sin(PHI)

# Reference values of set-valued friction at t = 5 s, as published.
PUBLISHED_U_X = 1.3305693378e-3  # m
PUBLISHED_U_Y = 1.474023e-7  # m


def initial_state() -> NDArray[np.float64]:
    """Return ``(u_x, u_y, s_x, s_y)`` at t = 0: X'(0) = epsilon V, springs relaxed."""
    return np.array([0.0, 0.0, EPSILON * V_X, EPSILON * V_Y])


def spring_force(elongation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return ``(k_x u_x, k_y u_y)`` in N, shape (n, 2), of elongations in m, shape (n, 2)."""
    return elongation * np.array([K_X, K_Y])


@numba.njit(inline="always")
def rates(u_x: float, u_y: float, s_x: float, s_y: float, delta: float) -> tuple:
    """Right-hand side with the friction direction ``s/sqrt(|s|^2 + delta^2)``.

    With ``delta = 0`` these are the paper's Eqs. (4) and (5); at exactly zero slip, where those are
    0/0, the friction is then taken as zero.
    """
    squared = s_x * s_x + s_y * s_y
    friction = (MU_INF + (MU_0 - MU_INF) * math.exp(-math.sqrt(squared) / V_F)) * W
    length = math.sqrt(squared + delta * delta)
    pull = friction / (MASS * length) if length > 0.0 else 0.0
    return (
        V_X - s_x,
        V_Y - s_y,
        K_X / MASS * u_x - pull * s_x,
        K_Y / MASS * u_y - pull * s_y,
    )


@numba.njit
def jacobian(s_x: float, s_y: float, delta: float) -> np.ndarray:
    """Derivative of `rates` by the state, shape (4, 4)."""
    squared = s_x * s_x + s_y * s_y
    speed = math.sqrt(squared)
    length = math.sqrt(squared + delta * delta)
    excess = (MU_0 - MU_INF) * math.exp(-speed / V_F) * W / MASS
    pull = (MU_INF * W / MASS + excess) / length
    slope = -excess / (V_F * length) - pull * speed / length**2  # of the pull, by the speed
    along = slope / speed if speed > 0.0 else 0.0
    matrix = np.zeros((4, 4))
    matrix[0, 2] = matrix[1, 3] = -1.0
    matrix[2, 0] = K_X / MASS
    matrix[3, 1] = K_Y / MASS
    matrix[2, 2] = -pull - along * s_x * s_x
    matrix[2, 3] = matrix[3, 2] = -along * s_x * s_y
    matrix[3, 3] = -pull - along * s_y * s_y
    return matrix
