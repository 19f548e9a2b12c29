"""Sticks found by the return map: their angles, states and samples."""

from __future__ import annotations

from math import inf, nan

import numpy as np

from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import inlined, number, piece
from stiction.solver.multiscale.construction import add_counts
from stiction.solver.multiscale.inside import following_step, write_kept
from stiction.solver.multiscale.return_map import NEAR, Returns, Stick
from stiction.solver.multiscale.section import angle
from stiction.solver.multiscale.steps import take_steps
from stiction.solver.multiscale.walk import elongation_at_landing, sample_known_stick
from stiction.solver.problem import Problem, drive_rate
from stiction.solver.state import COMPLETED, NOTHING, RUNNING, Motion, State, at_takeoff, with_limit
from stiction.solver.stepping.limit import NEVER_ASKED
from stiction.solver.stick import stick_duration

SLIP_STEPS = number(1_000_000_000)
SAME = 1e-3  # of a slip: landings closer than this are the same


@inlined
def stick_of(problem: Problem, motion: Motion) -> Stick:
    """Return the stick that begins at a landing; its angle is NaN if the mass does not stick."""
    t, u_x, u_y = motion.t, motion.u_x, motion.u_y
    duration, _ = stick_duration(problem, t, u_x, u_y, inf)
    if not 0.0 < duration < inf:
        return Stick(t, t + duration, nan)
    v_x, v_y = drive_rate(problem, 0.0)
    return Stick(t, t + duration, angle(problem, u_x + v_x * duration, u_y + v_y * duration))


@inlined
def state_at_landing(problem: Problem, state: State, stick: Stick) -> State:
    """Return the state at the start of a stick."""
    motion, memory, counts = state
    u_x, u_y = elongation_at_landing(problem, stick)
    landing = Motion(stick.start, u_x, u_y, 0.0, motion.e_x, motion.e_y)
    return State(landing, at_takeoff(memory), counts)


@inlined
def sample_cycle(
    problem: Problem,
    state: State,
    stick: Stick,
    landing: float,
    accuracy: Accuracy,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
    known: Returns,
) -> tuple[int, State, int]:
    """Fill the samples of a stick and the slip until `landing` (s), by steps.

    The steps find their own landing, which does not matter, because samples do not influence the
    motion. Later samples are those of the next stick.
    """
    k = sample_known_stick(problem, stick, times, samples, k)
    if k == len(times) or times[k] > landing:
        return COMPLETED, state, k
    motion, memory, _ = state_at_landing(problem, state, stick)
    until = k
    while until < len(times) and times[until] <= landing:
        until += 1
    slip, counts = landing - stick.end, state.counts
    code, alone = RUNNING, State(motion, with_limit(memory, NEVER_ASKED), NOTHING)
    # it may stick for a moment although the map just has no stick
    while code == RUNNING and k < until and alone.motion.t < landing - SAME * slip:
        alone = State(alone.motion, alone.memory, NOTHING)
        code, alone, k, _ = take_steps(
            problem,
            alone,
            landing + slip,
            accuracy,
            SLIP_STEPS,
            times[:until],
            samples,
            k,
            known.stick,
            known,
        )
        counts = add_counts(counts, alone.counts)
    return code, State(state.motion, state.memory, counts), k


@inlined
def alike(known: Returns, place: int, theta: float) -> bool:
    """Return whether the steps of a remembered cycle represent those of one from an angle.

    The angle of the force at the take-off differs by the patches' error at most.
    """
    return (
        place >= 0
        and known.inside.spans[place, 1] > 0
        and abs(known.past[place, 0] - theta) <= NEAR * known.closing
    )


@piece
def sample_remembered(
    problem: Problem,
    known: Returns,
    place: int,
    stick: Stick,
    landing: float,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
) -> int:
    """Fill the samples of a stick and the slip until `landing` (s), from another cycle's steps.

    The phase is the time since take-off over the slip's duration.
    """
    k = sample_known_stick(problem, stick, times, samples, k)
    rows, first = known.inside.kept, known.inside.spans[place, 0]
    last = first + known.inside.spans[place, 1] - 1
    begin = rows[first, 0]
    ratio = (known.past[place, 2] - known.past[place, 3]) / (landing - stick.end)
    i = first
    while k < len(times) and times[k] <= landing:
        t = begin + (times[k] - stick.end) * ratio
        i = following_step(rows, i, last, t)
        k = write_kept(problem, rows, i, t - rows[i, 0], samples, k)
    return k
