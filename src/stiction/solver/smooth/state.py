"""The state of the smooth solver from step to step, so that it can pause anywhere and continue."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from stiction.solver.compilation.stand_in import called_from_both
from stiction.solver.state import Counts
from stiction.solver.stepping.limit import Limit


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
    velocities and internal states at its start and stages (4, 2 + n), predicts the next; limit :
    of steps about steady sliding.
    """

    h: float
    h_last: float
    ease: float
    warm: bool
    past: np.ndarray
    limit: Limit


class SmoothState(NamedTuple):
    """Everything that a paused run needs to continue with the same results; `internal` (n,)."""

    motion: SmoothMotion
    internal: np.ndarray
    memory: SmoothMemory
    counts: Counts


Numbers = tuple[tuple[Any, ...], tuple[Any, ...], tuple[Any, ...]]


@called_from_both
def with_numbers(state: SmoothState, numbers: Numbers) -> SmoothState:
    """Return the state with the same arrays, and new motion, memory and counts."""
    motion, (h, h_last, ease, warm, limit), counts = numbers
    memory = SmoothMemory(h, h_last, ease, warm, state.memory.past, limit)
    return SmoothState(SmoothMotion(*motion), state.internal, memory, Counts(*counts))


@called_from_both
def with_limit(state: SmoothState, limit: Limit) -> SmoothState:
    """Return the state with another limit of steps about steady sliding."""
    motion, internal, (h, h_last, ease, warm, past, _), counts = state
    return SmoothState(motion, internal, SmoothMemory(h, h_last, ease, warm, past, limit), counts)


def copy_of(state: SmoothState) -> SmoothState:
    """Return the state with arrays of its own."""
    motion, internal, memory, counts = state
    memory = memory._replace(past=memory.past.copy())
    return SmoothState(motion, internal.copy(), memory, counts)
