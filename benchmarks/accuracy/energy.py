"""The drive's work and its parts, integrated over a run as exactly as the run is solved.

The run is made twice: once for its stick intervals, then with samples at the nodes of a quadrature
that breaks at every stick and crowds towards its ends, where slip is not smooth in time. While
stuck, the spring force is linear in time and friction does no work: one node is exact. Samples
never influence the steps, so that both runs are the same.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import stiction as st
from stiction.solver.integrate import integrate

Floats = NDArray[np.float64]

PANELS = 12  # in a transverse period, and in a slip, at least; each of three Gauss points
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)
NODES, WEIGHTS = 0.5 * (_POINTS + 1.0), 0.5 * _WEIGHTS  # on (0, 1)


class Balance(NamedTuple):
    """Energies (J) since the start, at `t` (s), where sticks begin, and at the end of the run.

    Attributes
    ----------
    t : ndarray
        (n,).
    work : ndarray
        Of the drive on the spring and the damper.
    friction, damper : ndarray
        Dissipated.
    stored : ndarray
        In the springs and, over the moving plate, in the mass; less that at the start.
    nodes : tuple of ndarray
        The run at all nodes: time (s), elongation u_x (m) and its rate (m/s).
    """

    t: Floats
    work: Floats
    friction: Floats
    damper: Floats
    stored: Floats
    nodes: tuple[Floats, Floats, Floats]

    @property
    def residual(self) -> Floats:
        """Work less what became of it, J."""
        return self.work - self.friction - self.damper - self.stored


def balance(slider: st.Slider, duration: float, rtol: float, panels: int = PANELS) -> Balance:
    """Run a slider at a steady drive, and integrate its energies."""
    settings = st.Settings(duration=duration, sample_rate=0, rtol=rtol)
    description = st.Description(slider, st.Initial(), settings)
    sticks = st.simulate(slider, duration, sample_rate=0, rtol=rtol).stick_intervals
    period = 2.0 * np.pi * np.sqrt(slider.mass / slider.k_y)
    t, weights, marks = quadrature(sticks, duration, period, panels)
    u_x, u_y, s_x, s_y, f_x, f_y = integrate(description, t, 10**9, None).samples[:, :6].T

    (c, n), V = slider.direction, slider.motion.rate(0.0)[0]
    v_x, v_y = V * c - s_x, V * n - s_y
    pull = (slider.k_x * u_x + slider.c_x * v_x) * c + (slider.k_y * u_y + slider.c_y * v_y) * n
    spring = slider.k_x * u_x**2 + slider.k_y * u_y**2
    stored = 0.5 * (spring + slider.mass * (s_x**2 + s_y**2))
    powers = (V * pull, f_x * s_x + f_y * s_y, slider.c_x * v_x**2 + slider.c_y * v_y**2)
    work, friction, damper = (np.cumsum(power * weights)[marks] for power in powers)
    return Balance(t[marks], work, friction, damper, stored[marks] - stored[0], (t, u_x, v_x))


def quadrature(
    sticks: Floats, duration: float, period: float, panels: int
) -> tuple[Floats, Floats, NDArray[np.intp]]:
    """Return nodes (s), their weights (s), and the indices of those where a stick or the run ends.

    Parameters
    ----------
    sticks : ndarray
        (n, 2), s.
    duration : float
        s.
    period : float
        Of the fastest oscillation, s.
    panels : int
        Of three Gauss points each, in such a period and in each slip, at least.
    """
    starts, ends = np.append(0.0, sticks[:, 1]), np.append(sticks[:, 0], duration)
    length = ends - starts
    count = np.ceil(panels * np.maximum(1.0, length / period)).astype(int)
    which = np.repeat(np.arange(len(count)), count)
    within = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    x = (within[:, None] + NODES) / count[which, None]
    # t = x^3 (10 - 15 x + 6 x^2) of the slip: nodes crowd where it leaves a stick and enters one
    slip = starts[which, None] + length[which, None] * x**3 * (10.0 + x * (6.0 * x - 15.0))
    weight = (length / count)[which, None] * WEIGHTS * 30.0 * (x * (1.0 - x)) ** 2
    middle, held = sticks.mean(axis=1), np.diff(sticks, axis=1)[:, 0]
    mark = np.append(sticks[:, 0], duration)
    t = np.concatenate([[0.0], slip.ravel(), middle, mark])
    weights = np.concatenate([[0.0], weight.ravel(), held, np.zeros(len(mark))])
    order = np.argsort(t, kind="stable")
    marks = np.flatnonzero(order >= len(t) - len(mark))
    return t[order], weights[order], marks
