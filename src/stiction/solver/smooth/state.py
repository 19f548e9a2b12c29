"""The state of the smooth solver from step to step, so that it can pause anywhere and continue."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from stiction.solver.state import Counts


class SmoothMotion(NamedTuple):
    """Time (s), elongation (m), slip velocity (m/s) along x and y."""

    t: float
    u_x: float
    u_y: float
    s_x: float
    s_y: float


class SmoothMemory(NamedTuple):
    """Information of the last step for the next one.

    h : size to try next, s; h_last : size of the last step; ease : its error over
    tolerance, to the power -1/4; warm : whether `past`, slip
    velocities and internal states at its start and stages (4, 2 + n), predicts the next.
    """

    h: float
    h_last: float
    ease: float
    warm: bool
    past: np.ndarray


class SmoothState(NamedTuple):
    """Everything that a paused run needs to continue with the same results; `internal` (n,)."""

    motion: SmoothMotion
    internal: np.ndarray
    memory: SmoothMemory
    counts: Counts


Numbers = tuple[tuple[Any, ...], tuple[Any, ...], tuple[Any, ...]]


def with_numbers(state: SmoothState, numbers: Numbers) -> SmoothState:
    """Return the state with the arrays that it has, and these of motion, memory and counts."""
    motion, (h, h_last, ease, warm), counts = numbers
    memory = SmoothMemory(h, h_last, ease, warm, state.memory.past)
    return SmoothState(SmoothMotion(*motion), state.internal, memory, Counts(*counts))


def copy_of(state: SmoothState) -> SmoothState:
    """Return the state with arrays of its own."""
    motion, internal, (h, h_last, ease, warm, past), counts = state
    memory = SmoothMemory(h, h_last, ease, warm, past.copy())
    return SmoothState(motion, internal.copy(), memory, counts)
