"""The state of the loop from step to step, so that it can pause anywhere; its output arrays."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from stiction.machine import shortage
from stiction.solver.compilation.jit import inlined
from stiction.solver.compilation.stand_in import called_from_both
from stiction.solver.problem import System
from stiction.solver.stepping.limit import NO_LIMIT, Limit, elsewhere

FIRST_STEP = 0.05  # of the time in which the faster spring swings by a radian
PLAN_LEAST, PLAN_MOST = 0.4, 1.5  # of the size that the last error allows
STICK = 80.0  # bytes of memory per stick interval, for all tables and intermediate arrays
# how the loop ended; it runs on, or asks how long a step about steady sliding may be
ASKS, RUNNING = -2, -1
COMPLETED, STEP_UNDERFLOW, NON_FINITE, TOO_MANY_STEPS, CONTACT_LOST, TOO_MANY_STICKS = range(6)


@dataclass
class Output:
    """Samples at `times` (ascending, s), stick intervals, and the progress of both.

    `samples` (n, columns), `sticks` (m, 2) in s, `filled` samples, `used` steps.
    """

    times: np.ndarray
    samples: np.ndarray
    sticks: np.ndarray
    filled: int = 0
    used: int = 0

    def make_room(self, sticks: int) -> bool:
        """Double the room for stick intervals if `sticks` fill it; return whether there is some."""
        if sticks < len(self.sticks):
            return True
        if shortage(STICK * 2.0 * sticks):
            return False
        self.sticks = np.concatenate([self.sticks, np.empty_like(self.sticks)])
        return True


class Motion(NamedTuple):
    """Time (s), elongation (m), slip speed (m/s; zero while sticking) and its direction."""

    t: float
    u_x: float
    u_y: float
    r: float
    e_x: float
    e_y: float


CUT = 0.25  # of the size to try: a step so much shorter ends at a row of a table
Plan = tuple[float, float, float, float, float, float, float, float]
PLANNED = 8


class Memory(NamedTuple):
    """Information of the last steps for the next one.

    h : size to try next, s; plan : sizes of the first steps after a stick, from the previous
    cycle, which is similar; place : number of these steps taken;
    h_last : size of the last step; ease : its error over tolerance, to the power -1/4;
    warm : whether `p` and `w`, values of its cubics at 0 and the stages, predict the next;
    limit : of steps about steady sliding.
    """

    h: float
    plan: Plan
    place: int
    h_last: float
    ease: float
    warm: bool
    p: tuple[float, float, float, float]
    w: tuple[float, float, float, float]
    limit: Limit


class Counts(NamedTuple):
    """Steps accepted and rejected, Newton iterations, number and total time of sticks (s).

    mapped : number of sticks found by a return map (see `multiscale`) instead of steps.
    """

    steps: int
    rejected: int
    iterations: int
    sticks: int
    stuck: float
    mapped: int


NOTHING = Counts(0, 0, 0, 0, 0.0, 0)


class State(NamedTuple):
    """Everything that a paused run needs to continue with the same results."""

    motion: Motion
    memory: Memory
    counts: Counts


Plain = tuple[tuple[Any, ...], tuple[Any, ...], tuple[Any, ...]]


@inlined
def plain(state: State) -> Plain:
    """Return the state as tuples without names.

    Their conversion to Python objects takes a fraction of the time, and runs no Python code, in
    which an interrupt could arrive (see `interrupt`).
    """
    return state.motion[:], state.memory[:], state.counts[:]


@called_from_both
def state_from_plain(state: Plain) -> State:
    """Return the state from its plain tuples."""
    motion, memory, counts = state
    return State(Motion(*motion), Memory(*memory), Counts(*counts))


def first_step(system: System) -> float:
    """Return the size of the first step to try, s."""
    return FIRST_STEP / sqrt(max(system.k_x, system.k_y) / system.mass)


def start(system: System, t: float, u: tuple[float, float], slip: tuple[float, float]) -> State:
    """Return the initial state of a run."""
    r = sqrt(slip[0] ** 2 + slip[1] ** 2)
    e = (slip[0] / r, slip[1] / r) if r > 0.0 else (1.0, 0.0)
    h = first_step(system)
    nothing = (0.0, 0.0, 0.0, 0.0)
    plan = (h, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    memory = Memory(h, plan, 0, h, 1.0, False, nothing, nothing, NO_LIMIT)
    return State(Motion(t, u[0], u[1], r, e[0], e[1]), memory, NOTHING)


def drop_memory(memory: Memory, h: float) -> Memory:
    """Return the memory after a kink of the motion, with cubics that predict nothing."""
    plan, h_last, ease = memory.plan, memory.h_last, memory.ease
    return Memory(h, plan, PLANNED, h_last, ease, False, memory.p, memory.w, NO_LIMIT)


@inlined
def after_cut(memory: Memory) -> Memory:
    """Return the memory after a step that ends at a row of a table.

    The cubics of one much shorter than the next do not reach across that.
    """
    warm = memory.warm and memory.h_last > CUT * memory.h
    h, plan, place, h_last, ease, _, p, w, limit = memory
    return Memory(h, plan, place, h_last, ease, warm, p, w, limit)


@inlined
def with_limit(memory: Memory, limit: Limit) -> Memory:
    """Return the memory with another limit of steps about steady sliding."""
    h, plan, place, h_last, ease, warm, p, w, _ = memory
    return Memory(h, plan, place, h_last, ease, warm, p, w, limit)


@inlined
def at_takeoff(memory: Memory) -> Memory:
    """Return the memory at the end of a stick."""
    h, h_last, ease, limit = memory.plan[0], memory.h_last, memory.ease, elsewhere(memory.limit)
    return Memory(h, memory.plan, 0, h_last, ease, False, memory.p, memory.w, limit)


@inlined
def write_plan(plan: Plan, place: int, h: float) -> Plan:
    """Return the plan with the size `h` at one of its places."""
    return (
        h if place == 0 else plan[0],
        h if place == 1 else plan[1],
        h if place == 2 else plan[2],
        h if place == 3 else plan[3],
        h if place == 4 else plan[4],
        h if place == 5 else plan[5],
        h if place == 6 else plan[6],
        h if place == 7 else plan[7],
    )


@inlined
def size_to_try(memory: Memory) -> float:
    """Return the size of the next step: the plan's, unless the last step contradicts it."""
    if 0 < memory.place < PLANNED and memory.plan[memory.place] > 0.0:
        return min(max(memory.plan[memory.place], PLAN_LEAST * memory.h), PLAN_MOST * memory.h)
    return memory.h


@inlined
def count_step(counts: Counts, rejected: int, iterations: int) -> Counts:
    """Return the counts with one more step."""
    return Counts(
        counts.steps + 1,
        counts.rejected + rejected,
        counts.iterations + iterations,
        counts.sticks,
        counts.stuck,
        counts.mapped,
    )
