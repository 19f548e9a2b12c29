"""The multiscale loop: cycles by the return map where it is known, by steps elsewhere."""

from __future__ import annotations

from math import inf

import numpy as np

from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import compiled, inlined
from stiction.solver.exact.loop import at_rest
from stiction.solver.multiscale.construction import chart
from stiction.solver.multiscale.history import recall, remember
from stiction.solver.multiscale.interpolant import cycle_from, locate
from stiction.solver.multiscale.replay import (
    alike,
    sample_cycle,
    sample_remembered,
    state_at_landing,
    stick_of,
)
from stiction.solver.multiscale.return_map import (
    CYCLES_SOLVED,
    EDGES_MET,
    FAR,
    LAST_ANGLE,
    LAST_TIME,
    MAY_COST,
    NODES_VAIN,
    OF_A_CYCLE,
    PATCH_START,
    PATCHES,
    PATCHES_MADE,
    Cycle,
    Returns,
    Stick,
)
from stiction.solver.multiscale.section import wrap_angle
from stiction.solver.multiscale.steps import take_steps
from stiction.solver.multiscale.walk import follow_patches
from stiction.solver.problem import Problem
from stiction.solver.state import COMPLETED, RUNNING, Counts, Plain, State, plain

PAYS = 8.0  # cycles that a patch must replace to pay
VAIN = 30  # wasted nodes allowed at first, plus one for each so many solved cycles
VAIN_EACH = 4
BESIDE = 0.3  # of the width to try: a patch that begins nearer may be overlapped
SHORTER = 0.25  # of the steps beside a map: so many more are taken, 1 - STEP_SHARE^(1/4), (M39)


@inlined
def reach(known: Returns, theta: float, turn: float) -> float:
    """Return the range of angles from `theta` on to try as a patch.

    It is at most half way to an edge, a quarter if the last attempt from here failed, and does not
    overlap another patch unless that is near.
    """
    way = 1.0 if turn > 0.0 else -1.0
    width = float(known.width[0])
    tried = known.patches[min(known.sizes[PATCHES_MADE], PATCHES - 1), PATCH_START]
    part = 0.25 if tried == theta - turn else 0.5
    for i in range(known.sizes[EDGES_MET]):
        gap = way * float(known.edges[i] - theta)
        if gap >= 0.0:
            width = min(width, part * gap)
    for i in range(known.sizes[PATCHES_MADE]):
        gap = way * float(known.patches[i, PATCH_START] - theta)
        if gap > BESIDE * width:
            width = min(width, gap)
    return way * width


@inlined
def pays(known: Returns, stick: Stick, cycle: Cycle, over: float, t_end: float) -> bool:
    """Return whether a patch over some angles pays, by the cost of the last cycle.

    It must replace enough cycles, there must be room for it, few nodes may have been wasted, and
    the map may still cost some steps.
    """
    left = (t_end - stick.end) / cycle.time
    return (
        min(abs(over), abs(cycle.turn) * left) >= PAYS * abs(cycle.turn)
        and left >= PAYS
        and max(known.sizes[PATCHES_MADE], known.sizes[EDGES_MET]) < PATCHES
        and known.sizes[NODES_VAIN] <= VAIN + known.sizes[CYCLES_SOLVED] // VAIN_EACH
        and known.balance[MAY_COST] > 0.0
    )


@inlined
def with_sticks(counts: Counts, sticks: int, stuck: float) -> Counts:
    """Return the counts plus sticks found by the map, of a total duration `stuck` (s)."""
    return Counts(
        counts.steps,
        counts.rejected,
        counts.iterations,
        sticks,
        counts.stuck + stuck,
        counts.mapped + (sticks - counts.sticks),
    )


@inlined
def known_cycle(known: Returns, theta: float, last: Cycle) -> tuple[bool, Cycle, int]:
    """Return whether the cycle from an angle is known, the cycle, and the similar past one."""
    row, x = locate(known, theta)
    if row >= 0:
        return True, cycle_from(known, row, x), -1
    row, cycle = recall(known, theta, last)
    return row >= 0, cycle, row


@inlined
def learn_and_follow(
    problem: Problem,
    state: State,
    t_end: float,
    accuracy: Accuracy,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
    sticks: np.ndarray,
    known: Returns,
) -> tuple[int, State, int]:
    """Learn from the cycle that ends with the present stick, and follow the map from there."""
    stick, found_before = stick_of(problem, state.motion), state.counts.mapped
    theta, taken_off = known.last[LAST_ANGLE], known.last[LAST_TIME]
    cycle = Cycle(wrap_angle(stick.theta - theta), stick.end - taken_off, stick.end - stick.start)
    known.sizes[CYCLES_SOLVED] += 1
    if cycle.turn < inf:  # a number: both ends are known
        remember(known, theta, cycle)
    while cycle.turn < inf and state.counts.sticks < len(sticks):
        count = state.counts.sticks
        stick, cycle, count, stuck, k = follow_patches(
            problem, known, stick, cycle, sticks, count, t_end, times, samples, k
        )
        state = State(state.motion, state.memory, with_sticks(state.counts, count, stuck))
        if count == len(sticks):
            break
        found, following, like = known_cycle(known, stick.theta, cycle)
        if not found:
            over = reach(known, stick.theta, cycle.turn)
            if not pays(known, stick, cycle, over, t_end):
                break
            start, over = stick.theta - cycle.turn, over + cycle.turn  # no gap between patches
            state = chart(problem, accuracy, state, known, start, over, FAR * cycle.time)
            continue
        landing, end = stick.end + (following.time - following.held), stick.end + following.time
        if not stick.end < landing < end < t_end:
            break
        if k < len(times) and times[k] <= landing:
            if alike(known, like, stick.theta):
                k = sample_remembered(problem, known, like, stick, landing, times, samples, k)
            else:
                code, state, k = sample_cycle(
                    problem, state, stick, landing, accuracy, times, samples, k, known
                )
                if code > COMPLETED:
                    return code, state, k
        sticks[count, 0], sticks[count, 1] = stick.start, stick.end
        counts = with_sticks(state.counts, count + 1, stick.end - stick.start)
        state = State(state.motion, state.memory, counts)
        stick = Stick(landing, end, wrap_angle(stick.theta + following.turn))
        cycle = following
    if state.counts.mapped > found_before:
        known.balance[MAY_COST] += known.balance[OF_A_CYCLE] * (state.counts.mapped - found_before)
        state = state_at_landing(problem, state, stick)
    known.last[LAST_ANGLE], known.last[LAST_TIME] = stick.theta, stick.end
    return COMPLETED, state, k


@compiled
def stride(
    problem: Problem,
    state: State,
    t_end: float,
    accuracy: Accuracy,
    budget: int,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
    sticks: np.ndarray,
    known: Returns,
) -> tuple[int, Plain, int, int]:
    """Advance like `stiction.solver.exact.loop.take_steps`, by the return map where it is known.

    Parameters
    ----------
    problem, state, t_end, accuracy, budget, times, samples, k, sticks
        As there; drive and load are steady.
    known : Returns
        The known part of the map, which grows.

    Returns
    -------
    code, state, k, turns
        As there; it ends early where the map has cost too much.
    """
    turns = 0
    while True:
        rests = at_rest(problem, state.motion, accuracy)
        if rests and not known.last[LAST_TIME] >= state.motion.t:
            steps = state.counts.steps
            code, state, k = learn_and_follow(
                problem, state, t_end, accuracy, times, samples, k, sticks, known
            )
            turns += state.counts.steps - steps
            if code > COMPLETED:
                return code, plain(state), k, turns
        if turns >= budget or state.counts.sticks == len(sticks) or known.balance[MAY_COST] < 0.0:
            return RUNNING, plain(state), k, turns
        if rests:
            known.record.used[0] = 0
        room = sticks[: state.counts.sticks + (1 if rests else 0)]  # until the next landing
        most = int(min(budget - turns, 1.0 + known.balance[MAY_COST] / SHORTER))
        code, state, k, used = take_steps(
            problem, state, t_end, accuracy, most, times, samples, k, room, known
        )
        turns += used
        known.balance[MAY_COST] -= SHORTER * used
        if code != RUNNING:
            return code, plain(state), k, turns
