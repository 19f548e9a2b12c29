"""What the smooth solver carries from step to step, so that it can pause anywhere and go on."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.solver.state import Counts


class Motion(NamedTuple):
    """Time (s), elongation (m), slip velocity (m/s) along x and y."""

    t: float
    u_x: float
    u_y: float
    s_x: float
    s_y: float


class Memory(NamedTuple):
    """What the last step teaches the next one.

    h : size to try next, s; h_last : size of the last step; warm : whether `past`, slip
    velocities and internal states at its start and stages (4, 2 + n), predicts the next.
    """

    h: float
    h_last: float
    warm: bool
    past: np.ndarray


class State(NamedTuple):
    """Everything that a paused run needs to go on, and come out the same; `internal` (n,)."""

    motion: Motion
    internal: np.ndarray
    memory: Memory
    counts: Counts
