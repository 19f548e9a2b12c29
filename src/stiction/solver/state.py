"""What the loop carries from step to step, so that it can pause anywhere and go on."""

from __future__ import annotations

from math import sqrt
from typing import Any, NamedTuple

from stiction.solver.compilation.jit import inlined
from stiction.system.slider import Slider

RUNNING, COMPLETED, STEP_UNDERFLOW, NON_FINITE, TOO_MANY_STEPS, CONTACT_LOST = -1, 0, 1, 2, 3, 4


class Accuracy(NamedTuple):
    """What a step is held to.

    tolerance : relative error of the slip velocity and of the friction's direction in a step;
    newton : relative size of Newton corrections that do no longer matter;
    speed : slip speed below which these are absolute, m/s; free_x, free_y : what friction alone
    can do to the elongation rates, mu_0 W/sqrt(m k), m/s: a vigorous slip may be relative to
    itself, but not so that the springs' own motion is lost; longest : step size that still sees
    what drive and load do, s; drive : its speed along x, or along y
    if it has none there, m/s, up to which a slip is held to itself;
    square_x, square_y : of the time in which each spring swings by a radian, m/k, s^2;
    touch : what friction must have to spare in a stick that is one, m/s; least : motion about
    steady sliding that is still told from rounding, m/s.
    """

    tolerance: float
    newton: float
    speed: float
    free_x: float
    free_y: float
    longest: float
    drive: float
    square_x: float
    square_y: float
    touch: float
    least: float


class Motion(NamedTuple):
    """Time (s), elongation (m), slip speed (m/s; zero while sticking) and its direction."""

    t: float
    u_x: float
    u_y: float
    r: float
    e_x: float
    e_y: float


Plan = tuple[float, float, float, float, float, float, float, float]
PLANNED = 8


class Memory(NamedTuple):
    """What the last steps teach the next one.

    h : size to try next, s; plan : the same for the first steps after a stick, from the last
    time, since one cycle is much like the next; place : how many of these have been taken;
    h_last : size of the last step; ease : its error over tolerance, to the power -1/4;
    warm : whether `p` and `w`, values of its cubics at 0 and the stages, predict the next.
    """

    h: float
    plan: Plan
    place: int
    h_last: float
    ease: float
    warm: bool
    p: tuple[float, float, float, float]
    w: tuple[float, float, float, float]


class Counts(NamedTuple):
    """Steps accepted and rejected, Newton iterations, stick intervals and their sum (s).

    mapped : stick intervals that a return map found (see `multiscale`), all others steps did.
    """

    steps: int
    rejected: int
    iterations: int
    sticks: int
    stuck: float
    mapped: int


NOTHING = Counts(0, 0, 0, 0, 0.0, 0)


class State(NamedTuple):
    """Everything that a paused run needs to go on, and come out the same."""

    motion: Motion
    memory: Memory
    counts: Counts


Plain = tuple[tuple[Any, ...], tuple[Any, ...], tuple[Any, ...]]


@inlined
def plain(state: State) -> Plain:
    """Return the state as tuples without names.

    They are made into Python's in a fraction of the time, and without Python's own code, in which
    an interrupt may arrive (see `interrupt`).
    """
    return state.motion[:], state.memory[:], state.counts[:]


def named(state: Plain) -> State:
    """Return the state that `plain` was given."""
    motion, memory, counts = state
    return State(Motion(*motion), Memory(*memory), Counts(*counts))


def first_step(slider: Slider) -> float:
    """Return the size of the first step to try, s."""
    return 0.05 / sqrt(max(slider.k_x, slider.k_y) / slider.mass)


def start(slider: Slider, t: float, u: tuple[float, float], slip: tuple[float, float]) -> State:
    """Return the state from which a run starts."""
    r = sqrt(slip[0] ** 2 + slip[1] ** 2)
    e = (slip[0] / r, slip[1] / r) if r > 0.0 else (1.0, 0.0)
    h = first_step(slider)
    nothing = (0.0, 0.0, 0.0, 0.0)
    plan = (h, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    memory = Memory(h, plan, 0, h, 1.0, False, nothing, nothing)
    return State(Motion(t, u[0], u[1], r, e[0], e[1]), memory, NOTHING)


def cooled(memory: Memory, h: float) -> Memory:
    """Return a memory whose cubics predict nothing: the motion has a kink here."""
    return Memory(h, memory.plan, PLANNED, memory.h_last, memory.ease, False, memory.p, memory.w)


@inlined
def at_takeoff(memory: Memory) -> Memory:
    """Return the memory at the end of a stick."""
    h = memory.plan[0]
    return Memory(h, memory.plan, 0, memory.h_last, memory.ease, False, memory.p, memory.w)


@inlined
def planned(plan: Plan, place: int, h: float) -> Plan:
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
    """Return the size of the next step: the plan's, if the last step does not speak against it."""
    if 0 < memory.place < PLANNED and memory.plan[memory.place] > 0.0:
        return min(max(memory.plan[memory.place], 0.4 * memory.h), 1.5 * memory.h)
    return memory.h


@inlined
def counted(counts: Counts, rejected: int, iterations: int) -> Counts:
    """Return the counts with one more step."""
    return Counts(
        counts.steps + 1,
        counts.rejected + rejected,
        counts.iterations + iterations,
        counts.sticks,
        counts.stuck,
        counts.mapped,
    )
