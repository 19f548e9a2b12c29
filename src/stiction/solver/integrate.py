"""From a description to samples and stick intervals, by the exact or the regularised solver."""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from typing import NamedTuple

import numpy as np

from stiction.description import Description
from stiction.slider import Slider
from stiction.solver import loop, regularised
from stiction.solver.problem import problem
from stiction.solver.sampling import COLUMNS
from stiction.solver.state import RUNNING, TOO_MANY_STEPS, Counts, start

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

    The local error estimate falls with h^4 (the interior of a step), the error of the
    result with h^5 to h^6 (its end); the power 2/3 makes the result's error proportional to
    rtol, as RADAU5 does (Hairer & Wanner, section IV.8). The factor is measured on Fig. 3.
    """
    return 0.2 * rtol ** (2 / 3)


def speed_scale(slider: Slider) -> float:
    """Return the slip speed (m/s) that the tolerance is relative to, beside the slip itself.

    V sin(phi) is what the transverse motion slips at. Without it, V; without a drive,
    a millionth of what friction can do to the mass on its spring.
    """
    c, s = slider.direction
    X, Y = slider.motion.rate(0.0)
    free = slider.F_0 / sqrt(slider.mass * max(slider.k_x, slider.k_y))
    return abs(X * s + Y * c) or abs(X * c - Y * s) or 1e-6 * free or 1e-12


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
    local, speed = tolerance(settings.rtol), speed_scale(slider)
    delta = settings.regularisation
    samples, sticks, k, used = np.empty((len(times), COLUMNS)), np.empty((256, 2)), 0, 0
    code = RUNNING
    while code == RUNNING:
        budget = min(BUDGET, max_steps - used)
        if budget <= 0:
            code = TOO_MANY_STEPS
        elif delta is None:
            code, state, k, turns = loop.advance(
                system, state, end, local, speed, budget, times, samples, k, sticks
            )
            used += turns
            if state.counts.sticks == len(sticks):
                sticks = np.concatenate([sticks, np.empty_like(sticks)])
        else:
            code, state, k, turns = regularised.advance(
                system, delta, state, end, local, speed, budget, times, samples, k
            )
            used += turns
        if progress is not None:
            progress((state.motion.t - initial.time) / settings.duration)
    counts = Counts(*state.counts)
    return Solution(code, times[:k], samples[:k], sticks[: counts.sticks].copy(), counts)
