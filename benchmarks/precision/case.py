"""The case that every solver is given: Fig. 3 of Nakano & Popov, 5 s of it; constants in SI.

Nothing but NumPy is imported here: a peer may live in an interpreter that has no more.
"""

from __future__ import annotations

import math

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

# Values of set-valued friction at t = 5 s, as published.
PUBLISHED_U_X = 1.3305693378e-3  # m
PUBLISHED_U_Y = 1.474023e-7  # m


def drive(phi: float = PHI) -> tuple[float, float]:
    """Return the drive velocity along x and y, m/s."""
    return V * math.cos(phi), V * math.sin(phi)


def initial_state(phi: float = PHI) -> NDArray[np.float64]:
    """Return ``(u_x, u_y, s_x, s_y)`` at t = 0: X'(0) = epsilon V, springs relaxed."""
    v_x, v_y = drive(phi)
    return np.array([0.0, 0.0, EPSILON * v_x, EPSILON * v_y])


def spring_force(elongation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return ``(k_x u_x, k_y u_y)`` in N, shape (n, 2), of elongations in m, shape (n, 2)."""
    return elongation * np.array([K_X, K_Y])
