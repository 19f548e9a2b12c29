"""The loop: stick, take off, slip, land, until the time or the step budget is used up."""

from __future__ import annotations

from math import isfinite

import numpy as np

from stiction.solver.compiled import compiled, inlined
from stiction.solver.frame import frame_of, outset
from stiction.solver.landing import land, pursuit
from stiction.solver.phases import slip, stick
from stiction.solver.problem import Problem, isotropic
from stiction.solver.state import (
    COMPLETED,
    NON_FINITE,
    RUNNING,
    STEP_UNDERFLOW,
    Accuracy,
    Motion,
    Plain,
    State,
    plain,
)
from stiction.solver.stick import margin


@inlined
def at_rest(problem: Problem, motion: Motion, accuracy: Accuracy) -> bool:
    """Return whether the slip is zero for every purpose.

    On an ellipse no closed form ends a slip, and its direction goes on turning as it vanishes:
    there a slip that friction is about to end need not be followed so far.
    """
    tolerated = accuracy.tolerance * accuracy.speed
    if isotropic(problem.surface) or motion.r > 1e-3 * tolerated:
        return motion.r < 1e-13 * tolerated
    return margin(problem, motion.t, motion.u_x, motion.u_y)[0] < 0.0 or motion.r == 0.0


@inlined
def advance(
    problem: Problem,
    state: State,
    t_end: float,
    accuracy: Accuracy,
    budget: int,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
    sticks: np.ndarray,
) -> tuple[int, State, int, int]:
    """Advance until `t_end`, until the budget of steps is used up, or until a stick finds no room.

    Parameters
    ----------
    problem, state
        The system, and where it is.
    t_end : float
        s.
    accuracy : Accuracy
        What each step is held to.
    budget : int
        Steps to take at most.
    times, samples : ndarray
        Ascending output times (n,), and rows to fill (n, 7); see `sampling`.
    k : int
        The next row to fill.
    sticks : ndarray
        Rows (start, end) of stick intervals to fill, from ``state.counts.sticks`` on.

    Returns
    -------
    code, state, k, turns
        `turns` of the loop were taken, at most `budget`.
    """
    for turn in range(budget):
        motion = state.motion
        t = motion.t
        if t >= t_end:
            return COMPLETED, state, k, turn
        if not (isfinite(motion.u_x) and isfinite(motion.u_y) and isfinite(motion.r)):
            return NON_FINITE, state, k, turn
        if at_rest(problem, motion, accuracy):
            if state.counts.sticks >= len(sticks):
                return RUNNING, state, k, turn
            motion = Motion(t, motion.u_x, motion.u_y, 0.0, motion.e_x, motion.e_y)
            state = State(motion, state.memory, state.counts)
            ends, state, k = stick(problem, state, t_end, accuracy, times, samples, k, sticks)
            motion = state.motion
            if not ends:
                continue
        frame = frame_of(problem, motion)
        start = outset(problem, frame)
        if motion.r > 0.0:
            closed = pursuit(problem, frame, start, accuracy)
            if t + closed[0] < t_end:
                state, k = land(problem, frame, start, state, closed, times, samples, k)
                continue
        done, state, k = slip(problem, frame, start, state, t_end, accuracy, times, samples, k)
        if not done:
            return STEP_UNDERFLOW, state, k, turn
    code = COMPLETED if state.motion.t >= t_end else RUNNING
    return code, state, k, budget


@compiled
def steps(
    problem: Problem,
    state: State,
    t_end: float,
    accuracy: Accuracy,
    budget: int,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
    sticks: np.ndarray,
) -> tuple[int, Plain, int, int]:
    """Advance, and return the state as Python takes it best."""
    code, state, k, turns = advance(
        problem, state, t_end, accuracy, budget, times, samples, k, sticks
    )
    return code, plain(state), k, turns
