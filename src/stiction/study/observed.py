"""What the measures look at: one run's samples as plain arrays, and what they share."""

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
from stiction.study.regimes import Swings, kind_of, swings
from stiction.study.turning import Turns, turns

Floats = NDArray[np.float64]

# A harmonic's peak, found by a parabola through samples this dense, is right to 1e-5 of its
# amplitude. Samples cost time of their own: at this rate one part in a hundred.
PER_SLOW_PERIOD = 32
MOST_SAMPLES = 1_000_000  # of one run
# The fast oscillation is looked at over its last periods.
FAST_PERIODS, PER_FAST_PERIOD = 32, 16
# Smallest reversal of the force that counts, of its span: ten times what the fast oscillation
# makes of it in the paper's system, and small enough to see swings die out.
REVERSAL = 1e-3


@dataclass(frozen=True)
class Observed:
    """A run as the solver returns it: samples over all of it, then dense ones of its end.

    Parameters
    ----------
    description : Description
        What was run.
    solution : Solution
        Samples, stick intervals and counts.
    coarse : ndarray
        Which samples are evenly spaced over all of the run.
    """

    description: Description
    solution: Solution
    coarse: NDArray[np.bool_]

    @cached_property
    def time(self) -> Floats:
        """(n,), s, evenly spaced."""
        return self.solution.times[self.coarse]

    @cached_property
    def samples(self) -> Floats:
        """(n, 7 or more), at `time`; columns as in `stiction.solver.sampling`."""
        return self.solution.samples[self.coarse]

    @cached_property
    def way(self) -> float:
        """1 where the spring is pulled towards positive x, else -1."""
        slider = self.description.slider
        return -1.0 if slider.motion.velocity * slider.direction[0] < 0.0 else 1.0

    @cached_property
    def force(self) -> Floats:
        """Spring force k_x u_x, positive where it pulls along the drive (N)."""
        return self.way * self.description.slider.k_x * self.samples[:, 0]

    @cached_property
    def velocity(self) -> Floats:
        """Velocity of the mass along the drive, X', positive where it follows it (m/s)."""
        c, s = self.description.slider.direction
        return self.way * (c * self.samples[:, 2] + s * self.samples[:, 3])

    @cached_property
    def position(self) -> Floats:
        """Position of the mass along the drive, X (m), Eq. (6) of Nakano & Popov."""
        slider = self.description.slider
        c, s = slider.direction
        travel = slider.motion.travel(0.0, self.time)[0]
        position: Floats = self.way * (travel - c * self.samples[:, 0] - s * self.samples[:, 1])
        return position

    @cached_property
    def turns(self) -> Turns:
        """Where the force turns."""
        return turns(self.time, self.force, REVERSAL * float(np.ptp(self.force)))

    @cached_property
    def swings(self) -> Swings:
        """Complete swings of the force."""
        return swings(self.turns)

    @cached_property
    def first_slip(self) -> int:
        """The first sample at which the mass is faster than the drive; the last if it never is."""
        drive = np.abs(self.description.slider.motion.rate(self.time)[0])
        faster = self.velocity > drive
        found = int(np.argmax(faster))
        return found if faster[found] else len(faster) - 1

    @cached_property
    def song(self) -> float:
        """Amplitude of the fast oscillation's rate at the end, over the drive's velocity along it.

        Half the span of the elongation rate along the stiffer axis. It is 1 at most while the
        slip does not reverse (Nakano & Popov, below Eq. (9)).
        """
        slider, end = self.description.slider, self.solution.samples[~self.coarse]
        stiff = slider.k_y >= slider.k_x
        drive = abs(slider.motion.velocity * slider.direction[1 if stiff else 0])
        span = float(np.ptp(end[:, 3 if stiff else 2])) if len(end) else 0.0
        return 0.5 * span / drive if drive > 0.0 else 0.0

    @cached_property
    def regime(self) -> str:
        """The kind of motion, one of `stiction.study.regimes.KINDS`."""
        slider = self.description.slider
        drive = slider.k_x * abs(slider.motion.velocity * slider.direction[0])
        return kind_of(self.time, self.force, self.turns, drive, self.song)


def observe(description: Description, report: Callable[[float], None] | None) -> Observed:
    """Run a description, sampled as measures need it: as it says, or by its slow period."""
    start, duration = description.initial.time, description.run.duration
    slow, fast = frequencies(description)
    rate = min(description.run.sample_rate or PER_SLOW_PERIOD * slow, MOST_SAMPLES / duration)
    even = sample_times(start, duration, rate)
    count, step = FAST_PERIODS * PER_FAST_PERIOD, 1.0 / (PER_FAST_PERIOD * fast)
    dense = start + duration - step * np.arange(count)
    times = np.concatenate([even, dense[dense > start]])
    order = np.argsort(times, kind="stable")
    solution = solve(description, times[order], progress=report)
    return Observed(description, solution, (order < len(even))[: len(solution.times)])


def seconds_of(description: Description) -> float:
    """Return about what a run takes (s), by what the paper's takes in each fast period."""
    return 1e-4 + 1.6e-6 * frequencies(description)[1] * description.run.duration


def frequencies(description: Description) -> tuple[float, float]:
    """Return the two natural frequencies, the slower first (Hz)."""
    slider = description.slider
    low, high = sorted((slider.k_x, slider.k_y))
    return sqrt(low / slider.mass) / (2.0 * pi), sqrt(high / slider.mass) / (2.0 * pi)
