"""What the measures look at: one run's samples as plain arrays, and how it ended."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

from stiction.description import Description
from stiction.simulation import sample_times, solve
from stiction.solver.integrate import Solution

Floats = NDArray[np.float64]

# A harmonic's peak, found by a parabola through samples this dense, is right to 1e-5 of its
# amplitude. Samples cost time of their own: at this rate one part in a hundred.
PER_SLOW_PERIOD = 32
MOST_SAMPLES = 1_000_000  # of one run


@dataclass(frozen=True)
class Observed:
    """A run as the solver returns it.

    Parameters
    ----------
    description : Description
        What was run.
    solution : Solution
        Samples, stick intervals and counts.
    """

    description: Description
    solution: Solution

    @property
    def time(self) -> Floats:
        """(n,), s."""
        return self.solution.times

    @cached_property
    def way(self) -> float:
        """1 where the spring is pulled towards positive x, else -1."""
        slider = self.description.slider
        return -1.0 if slider.motion.velocity * slider.direction[0] < 0.0 else 1.0

    @cached_property
    def force(self) -> Floats:
        """Spring force along the drive, k_x u_x, positive where it pulls along it (N)."""
        return self.way * self.description.slider.k_x * self.solution.samples[:, 0]

    @cached_property
    def velocity(self) -> Floats:
        """Velocity of the mass along the drive, X', positive where it follows it (m/s)."""
        c, s = self.description.slider.direction
        slip = self.solution.samples
        return self.way * (c * slip[:, 2] + s * slip[:, 3])

    @cached_property
    def position(self) -> Floats:
        """Position of the mass along the drive, X (m), Eq. (6) of Nakano & Popov."""
        slider, samples = self.description.slider, self.solution.samples
        c, s = slider.direction
        travel = slider.motion.travel(0.0, self.time)[0]
        position: Floats = self.way * (travel - c * samples[:, 0] - s * samples[:, 1])
        return position


def observe(description: Description, report: Callable[[float], None] | None) -> Observed:
    """Run a description, sampled as measures need it: as it says, or by its slow period."""
    start, duration = description.initial.time, description.run.duration
    rate = description.run.sample_rate or slow_rate(description)
    rate = min(rate, MOST_SAMPLES / duration)
    times = sample_times(start, duration, rate)
    return Observed(description, solve(description, times, progress=report))


def slow_rate(description: Description) -> float:
    """Return a sample rate (Hz) for the slower of the two natural oscillations."""
    return PER_SLOW_PERIOD * frequencies(description)[0]


def seconds_of(description: Description) -> float:
    """Return about what a run takes (s), by what the paper's takes in each fast period."""
    return 1e-4 + 1.6e-6 * frequencies(description)[1] * description.run.duration


def frequencies(description: Description) -> tuple[float, float]:
    """Return the two natural frequencies, the slower first (Hz)."""
    slider = description.slider
    low, high = sorted((slider.k_x, slider.k_y))
    return sqrt(low / slider.mass) / (2.0 * pi), sqrt(high / slider.mass) / (2.0 * pi)
