"""From a description to samples and stick intervals, by the exact or the regularised solver."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from stiction.description import Description
from stiction.drive import jump
from stiction.friction import has_state
from stiction.slider import Slider
from stiction.solver import loop, regularised
from stiction.solver.compiled import specialised
from stiction.solver.frame import friction
from stiction.solver.interrupt import uninterrupted
from stiction.solver.problem import Problem
from stiction.solver.sampling import COLUMNS
from stiction.solver.state import (
    COMPLETED,
    CONTACT_LOST,
    RUNNING,
    TOO_MANY_STEPS,
    Accuracy,
    Counts,
    Motion,
    State,
    cooled,
    start,
)
from stiction.solver.stick import holding
from stiction.solver.stretch import Stretch, load_bounds, speeds, stretches, system_of
from stiction.solver.surface import friction_along

BUDGET = 100_000  # turns of the loop between two looks at the clock: some 30 ms


class Solution(NamedTuple):
    """How the integration ended (an index into `Status`), what it found and what it took.

    `times` (n,) are those reached, `samples` (n, 7) as in `stiction.solver.sampling`,
    `sticks` (m, 2) in s.
    """

    code: int
    times: np.ndarray
    samples: np.ndarray
    sticks: np.ndarray
    counts: Counts


def tolerance(rtol: float) -> float:
    """Return the local tolerance for a wanted relative error of the result.

    The estimate of the local error falls with h^4 (the cubic inside a step), the error of
    the result with h^5 (the order of the method), hence the power 4/5: the result's error is
    then proportional to rtol. The factor is measured on Fig. 3 over 5 s, where the relative
    error of u_x comes out at a third of rtol.
    """
    return 1.26 * float(rtol**0.8)


def accuracy(slider: Slider, stretch: Stretch, start: float, rtol: float) -> Accuracy:
    """Return what each step in a stretch is held to.

    Its speed: V sin(phi) is what the transverse motion slips at; without it, V; without a
    drive, a millionth of what friction can do to the mass on its spring, and never more than
    that whole. Friction that weakens at the rate g = -F'(0)/m per second makes slip grow out
    of its first k V/(m g^2), which must then be resolved; k is the stiffness that acts.
    """
    along, across = speeds(slider, stretch.problem.drive, start, stretch.end)
    law: Any = slider.law
    load = load_bounds(stretch.problem.load, start, stretch.end)[0]
    mu = slider.F_0 / slider.normal_load
    free_x, free_y = (mu * load / sqrt(slider.mass * k) for k in (slider.k_x, slider.k_y))
    free = min(free_x, free_y)
    speed, k = (across, slider.k_y) if across > 0.0 else (along or 1e-6 * free, slider.k_x)
    if free > 0.0:
        speed = min(speed, free)
    weakening = 0.0 if has_state(law) else max(0.0, -law.slope(0.0)) * load
    speed = max(speed / (1.0 + weakening**2 / (k * slider.mass)), 1e-15)
    local = tolerance(rtol)
    # Newton's error must not show in a step's end, which is better than its inside
    newton = min(0.2, 100.0 * sqrt(local)) * local
    return Accuracy(local, newton, speed, free_x, free_y)


@dataclass
class Output:
    """What is filled in on the way: samples at `times`, stick intervals, steps used."""

    times: np.ndarray
    samples: np.ndarray
    sticks: np.ndarray
    filled: int = 0
    used: int = 0


Report = Callable[[float], None]


def integrate(
    description: Description, times: np.ndarray, max_steps: int, progress: Report | None
) -> Solution:
    """Integrate a description, filling in the samples at `times` (ascending, s)."""
    slider, initial, settings = description
    t, end = initial.time, initial.time + settings.duration
    state = start(system_of(slider), t, (initial.u_x, initial.u_y), initial.slip(slider))
    out = Output(times, np.empty((len(times), COLUMNS)), np.empty((256, 2)))
    code, stretch = COMPLETED, None

    def report(t: float) -> None:
        if progress is not None:
            progress((t - initial.time) / settings.duration)

    with uninterrupted() as release:
        for stretch in stretches(slider, t, end):
            state = entered(state, slider, t)
            held = accuracy(slider, stretch, t, settings.rtol)
            code, state = through(
                stretch, settings.regularisation, state, held, max_steps, out, release, report
            )
            t = stretch.end
            if code == COMPLETED and stretch.lost:
                code = CONTACT_LOST
            if code != COMPLETED:
                break
    assert stretch is not None
    k, counts = out.filled, Counts(*state.counts)
    times, samples = times[:k], out.samples[:k]
    if code != COMPLETED:  # keep where it stopped, whatever the sample rate
        earlier = times < state.motion.t
        times = np.append(times[earlier], state.motion.t)
        samples = np.vstack([samples[earlier], last_row(stretch.problem, state.motion)])
    sticks = joined(out.sticks[: counts.sticks])
    return Solution(code, times, samples, sticks, counts._replace(sticks=len(sticks)))


def entered(state: State, slider: Slider, t: float) -> State:
    """Return the state at the start of a stretch: after the jump of the drive, if it jumps.

    The mass keeps its velocity. That over a plate which is driven jumps with the plate's;
    over a plate at rest it does not. The memory of earlier steps is of no use after a bend.
    """
    memory = cooled(state.memory, min(state.memory.h, state.memory.h_takeoff))
    m = state.motion
    X, Y = jump(slider.motion, t) if slider.driven == "plate" else (0.0, 0.0)
    if X == Y == 0.0:
        return State(m, memory, state.counts)
    c, s = slider.direction
    slip_x, slip_y = m.r * m.e_x + X * c - Y * s, m.r * m.e_y + X * s + Y * c
    r = sqrt(slip_x * slip_x + slip_y * slip_y)
    e = (slip_x / r, slip_y / r) if r > 0.0 else (m.e_x, m.e_y)
    return State(Motion(m.t, m.u_x, m.u_y, r, *e), memory, state.counts)


def through(
    stretch: Stretch,
    delta: float | None,
    state: State,
    held: Accuracy,
    max_steps: int,
    out: Output,
    release: Callable[[], None],
    report: Report,
) -> tuple[int, State]:
    """Integrate through a stretch; return how that ended, and the state."""
    system, end = stretch.problem, stretch.end
    kinds: tuple[Any, ...] = (type(system.law), type(system.drive), type(system.load))
    advance = specialised(loop.advance if delta is None else regularised.advance, *kinds)
    code = RUNNING
    while code == RUNNING:
        release()
        budget = min(BUDGET, max_steps - out.used)
        if budget <= 0:
            return TOO_MANY_STEPS, state
        if delta is None:
            code, state, out.filled, turns = advance(
                system, state, end, held, budget, out.times, out.samples, out.filled, out.sticks
            )
        else:
            code, state, out.filled, turns = advance(
                system, delta, state, end, held, budget, out.times, out.samples, out.filled
            )
        out.used += turns
        if state.counts.sticks == len(out.sticks):
            out.sticks = np.concatenate([out.sticks, np.empty_like(out.sticks)])
        report(state.motion.t)
    return code, state


def joined(sticks: np.ndarray) -> np.ndarray:
    """Return stick intervals (n, 2) with those made one that go on from stretch to stretch."""
    if len(sticks) < 2:
        return sticks.copy()
    apart = sticks[1:, 0] > sticks[:-1, 1]
    return np.column_stack([sticks[np.r_[True, apart], 0], sticks[np.r_[apart, True], 1]])


def last_row(problem: Problem, motion: Motion) -> list[float]:
    """Return the sample of a state between two steps."""
    m = problem.system.mass
    slip = [motion.r * motion.e_x, motion.r * motion.e_y]
    if motion.r == 0.0:
        a_x, a_y = holding(problem, motion.t, motion.u_x, motion.u_y)
        return [motion.u_x, motion.u_y, *slip, m * a_x, m * a_y, 1.0]
    f = m * friction(problem, motion.t, motion.r)[0]
    f_x, f_y = friction_along(problem, motion.e_x, motion.e_y)
    return [motion.u_x, motion.u_y, *slip, f * f_x, f * f_y, 0.0]
