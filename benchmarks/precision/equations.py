"""The regularised equations of the case for peers that need them, compiled with numba.

The state is ``(u_x, u_y, s_x, s_y)``: elongations (m) and slip velocity (m/s), ``s = v_d - du/dt``.
The elongation rates would do as well on paper, but slip is what the friction depends on and what is
small: with it as the state, LSODA passes tolerances at which it fails with the rates (and takes the
same time where both work). Parameters are ``(v_x, v_y, delta)``: drive velocity and regularisation,
in m/s.
"""

from __future__ import annotations

import math

import numba
import numpy as np

from benchmarks.precision.case import K_X, K_Y, MASS, MU_0, MU_INF, V_F, W


@numba.njit(inline="always")
def rates(u_x, u_y, s_x, s_y, v_x, v_y, delta):
    """Right-hand side with the friction direction ``s/sqrt(|s|^2 + delta^2)``.

    With ``delta = 0`` these are the paper's Eqs. (4) and (5); at exactly zero slip, where those are
    0/0, the friction is then taken as zero.
    """
    squared = s_x * s_x + s_y * s_y
    friction = (MU_INF + (MU_0 - MU_INF) * math.exp(-math.sqrt(squared) / V_F)) * W
    length = math.sqrt(squared + delta * delta)
    pull = friction / (MASS * length) if length > 0.0 else 0.0
    return (
        v_x - s_x,
        v_y - s_y,
        K_X / MASS * u_x - pull * s_x,
        K_Y / MASS * u_y - pull * s_y,
    )


@numba.njit(inline="always")
def slopes(s_x, s_y, delta):
    """Derivatives of the slip's rates by the slip: ``(xx, xy, yy)``, 1/s."""
    squared = s_x * s_x + s_y * s_y
    speed = math.sqrt(squared)
    length = math.sqrt(squared + delta * delta)
    excess = (MU_0 - MU_INF) * math.exp(-speed / V_F) * W / MASS
    pull = (MU_INF * W / MASS + excess) / length
    slope = -excess / (V_F * length) - pull * speed / length**2  # of the pull, by the speed
    along = slope / speed if speed > 0.0 else 0.0
    return -pull - along * s_x * s_x, -along * s_x * s_y, -pull - along * s_y * s_y


@numba.njit
def derivative(t, state, parameters, out):
    """Write `rates` of a state into `out`."""
    out[0], out[1], out[2], out[3] = rates(
        state[0], state[1], state[2], state[3], parameters[0], parameters[1], parameters[2]
    )


@numba.njit
def jacobian(t, state, parameters, out):
    """Write the derivative of `rates` by the state into `out`, (4, 4)."""
    xx, xy, yy = slopes(state[2], state[3], parameters[2])
    out[:] = 0.0
    out[0, 2] = out[1, 3] = -1.0
    out[2, 0] = K_X / MASS
    out[3, 1] = K_Y / MASS
    out[2, 2] = xx
    out[2, 3] = out[3, 2] = xy
    out[3, 3] = yy


@numba.njit
def derivative_of(t, state, parameters):
    """Return `rates` of a state as an array."""
    out = np.empty(4)
    derivative(t, state, parameters, out)
    return out


@numba.njit
def jacobian_of(t, state, parameters):
    """Return the derivative of `rates` by the state, (4, 4)."""
    out = np.empty((4, 4))
    jacobian(t, state, parameters, out)
    return out
