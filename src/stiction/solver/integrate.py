"""From a description to samples and stick intervals, by the exact or the regularised solver."""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from typing import NamedTuple

import numpy as np

from stiction.description import Description
from stiction.slider import Slider
from stiction.solver import loop, regularised
from stiction.solver.compiled import specialised
from stiction.solver.frame import friction
from stiction.solver.interrupt import uninterrupted
from stiction.solver.problem import Problem, problem
from stiction.solver.sampling import COLUMNS
from stiction.solver.state import (
    COMPLETED,
    RUNNING,
    TOO_MANY_STEPS,
    Accuracy,
    Counts,
    Motion,
    start,
)
from stiction.solver.stick import holding

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


def accuracy(slider: Slider, rtol: float) -> Accuracy:
    """Return what each step is held to.

    Its speed: V sin(phi) is what the transverse motion slips at; without it, V; without a
    drive, a millionth of what friction can do to the mass on its spring, and never more than
    that whole. Friction that weakens at the rate g = -F'(0)/m per second makes slip grow out
    of its first k V/(m g^2), which must then be resolved; k is the stiffness that acts.
    """
    c, s = slider.direction
    X, Y = slider.motion.rate(0.0)
    across, along = abs(X * s + Y * c), abs(X * c - Y * s)
    free_x, free_y = (slider.F_0 / sqrt(slider.mass * k) for k in (slider.k_x, slider.k_y))
    free = min(free_x, free_y)
    speed, k = (across, slider.k_y) if across > 0.0 else (along or 1e-6 * free, slider.k_x)
    if free > 0.0:
        speed = min(speed, free)
    weakening = max(0.0, -slider.law.slope(0.0)) * slider.load.at(0.0)
    speed = max(speed / (1.0 + weakening**2 / (k * slider.mass)), 1e-15)
    local = tolerance(rtol)
    # Newton's error must not show in a step's end, which is better than its inside
    newton = min(0.2, 100.0 * sqrt(local)) * local
    return Accuracy(local, newton, speed, free_x, free_y)


def integrate(
    description: Description,
    times: np.ndarray,
    max_steps: int,
    progress: Callable[[float], None] | None,
) -> Solution:
    """Integrate a description, filling in the samples at `times` (ascending, s)."""
    slider, initial, settings = description
    system = problem(slider)
    state = start(system.system, initial.time, (initial.u_x, initial.u_y), initial.slip(slider))
    end = initial.time + settings.duration
    held = accuracy(slider, settings.rtol)
    delta = settings.regularisation
    kinds = (type(system.law), type(system.drive), type(system.load))
    advance = specialised(loop.advance if delta is None else regularised.advance, *kinds)
    samples, sticks, k, used = np.empty((len(times), COLUMNS)), np.empty((256, 2)), 0, 0
    code = RUNNING
    with uninterrupted() as release:
        while code == RUNNING:
            release()
            budget = min(BUDGET, max_steps - used)
            if budget <= 0:
                code = TOO_MANY_STEPS
                break
            if delta is None:
                code, state, k, turns = advance(
                    system, state, end, held, budget, times, samples, k, sticks
                )
            else:
                code, state, k, turns = advance(
                    system, delta, state, end, held, budget, times, samples, k
                )
            used += turns
            if state.counts.sticks == len(sticks):
                sticks = np.concatenate([sticks, np.empty_like(sticks)])
            if progress is not None:
                progress((state.motion.t - initial.time) / settings.duration)
    times, samples = times[:k], samples[:k]
    if code != COMPLETED:  # keep where it stopped, whatever the sample rate
        times = np.append(times, state.motion.t)
        samples = np.vstack([samples, last_row(system, state.motion)])
    counts = Counts(*state.counts)
    return Solution(code, times, samples, sticks[: counts.sticks].copy(), counts)


def last_row(system: Problem, motion: Motion) -> list[float]:
    """Return the sample of a state between two steps."""
    m = system.system.mass
    slip = [motion.r * motion.e_x, motion.r * motion.e_y]
    if motion.r == 0.0:
        a_x, a_y = holding(system, motion.t, motion.u_x, motion.u_y)
        return [motion.u_x, motion.u_y, *slip, m * a_x, m * a_y, 1.0]
    f = m * friction(system, motion.t, motion.r)[0]
    return [motion.u_x, motion.u_y, *slip, f * motion.e_x, f * motion.e_y, 0.0]
