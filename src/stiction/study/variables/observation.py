"""What the measures look at: one run's samples as plain arrays, and what they share."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import ceil, nan, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.creep.first_slip import loading
from stiction.analysis.motion.regime import STUCK
from stiction.drive import ConstantVelocity
from stiction.simulation import sample_times, solve
from stiction.solver.integrate import Solution
from stiction.study.variables.fast_regime import Swings, cycles_among, kind_of, swings
from stiction.study.variables.features import Features, features
from stiction.system.description import Description
from stiction.system.slider import Slider

Floats = NDArray[np.float64]

# A peak found by a parabola through samples this dense is right to 1e-5 of the amplitude for a
# harmonic, to 1e-4 for the paper's. Samples cost time of their own: here one part in a hundred.
PER_SLOW_PERIOD = 32
PER_COUPLED_PERIOD = 16  # of the mass along the drive, on both springs, where friction holds it
LEAST_SAMPLES, MOST_SAMPLES = 64, 1_000_000  # of one run
# The fast oscillation is looked at over its last periods.
FAST_PERIODS, PER_FAST_PERIOD = 32, 16
# Smallest reversal of the force that counts, of its span in the last quarter: ten times what the
# fast oscillation makes of it in the paper's system, and small enough to see swings die out. It is
# no less than the solver's tolerance of the largest force.
REVERSAL = 1e-3


@dataclass(frozen=True)
class Observed:
    """A run as the solver returns it: evenly spaced samples, and finer ones of its end.

    Parameters
    ----------
    description : Description
        What was run.
    solution : Solution
        Samples, stick intervals and counts.
    fine : int
        The first of the finer samples.
    parts : int
        How many of them take the place of one.
    """

    description: Description
    solution: Solution
    fine: int
    parts: int

    @property
    def start(self) -> float:
        """When the run starts, s."""
        return float(self.solution.times[0])

    @property
    def end(self) -> float:
        """When it ends, s."""
        return float(self.solution.times[-1])

    @cached_property
    def time(self) -> Floats:
        """(n,), s, evenly spaced."""
        return self._even(self.solution.times)

    def column(self, i: int) -> Floats:
        """Return a column of the samples at `time`, as in `stiction.solver.exact.sampling`."""
        return self._even(self.solution.samples[:, i])

    def _even(self, values: Floats) -> Floats:
        return np.concatenate([values[: self.fine], values[self.fine :: self.parts]])

    @cached_property
    def way(self) -> float:
        """1 where the spring is pulled towards positive x, else -1."""
        slider = self.description.slider
        return -1.0 if slider.motion.velocity * slider.direction[0] < 0.0 else 1.0

    @cached_property
    def force(self) -> Floats:
        """Spring force k_x u_x, positive where it pulls along the drive (N)."""
        return self.way * self.description.slider.k_x * self.column(0)

    @cached_property
    def drive(self) -> Floats:
        """Velocity of the drive along X: one value if it is constant, else one a sample (m/s)."""
        motion = self.description.slider.motion
        constant = isinstance(motion, ConstantVelocity)
        return np.array([motion.velocity]) if constant else np.asarray(motion.rate(self.time)[0])

    @cached_property
    def rate(self) -> Floats:
        """Rate of the spring force, as the drive and the mass move its ends (N/s)."""
        slider = self.description.slider
        return self.way * slider.k_x * (slider.direction[0] * self.drive - self.column(2))

    @cached_property
    def velocity(self) -> Floats:
        """Velocity of the mass along the drive, X', positive where it follows it (m/s)."""
        c, s = self.description.slider.direction
        return self.way * c * self.column(2) + self.way * s * self.column(3)

    @property
    def positions(self) -> Floats:
        """Position X of the mass along the drive (m): Eq. (6) of Nakano & Popov."""
        slider = self.description.slider
        c, s = slider.direction
        travel = slider.motion.travel(0.0, self.time)[0]
        return np.asarray(self.way * (travel - c * self.column(0) - s * self.column(1)))

    @cached_property
    def features(self) -> Features:
        """What the evenly spaced samples show."""
        least = self.description.run.rtol
        found: Features = features(self.time, self.force, self.rate, self.velocity, REVERSAL, least)
        return found

    @cached_property
    def first_slip(self) -> tuple[float, float]:
        """When the first slip begins (s), and how far the mass came until then (m)."""
        slider, (c, s) = self.description.slider, self.description.slider.direction
        drive = np.broadcast_to(self.drive, self.time.shape)
        at = loading(slider, c * self.column(0) + s * self.column(1), drive).slip
        if at < 0:
            return nan, nan
        positions = self.positions
        return float(self.time[at]), float(positions[at] - positions[0])

    @cached_property
    def swings(self) -> Swings:
        """Complete swings of the force."""
        return swings(self.features)

    @cached_property
    def cycles(self) -> Swings:
        """The swings that are cycles."""
        return cycles_among(self.swings, self.end)

    @cached_property
    def transverse_oscillation(self) -> float:
        """Amplitude of the fast oscillation's rate at the end, over the drive's velocity along it.

        Half the span of the elongation rate along the stiffer axis. It is 1 at most while the
        slip does not reverse (Nakano & Popov, below Eq. (9)).
        """
        slider, samples = self.description.slider, self.solution.samples
        axis = 1 if slider.k_y >= slider.k_x else 0
        drive = abs(slider.motion.velocity * slider.direction[axis])
        rate = samples[self.fine :, 2 + axis]
        return 0.5 * float(rate.max() - rate.min()) / drive if drive > 0.0 else 0.0

    @cached_property
    def regime(self) -> str:
        """The kind of motion, one of `stiction.study.variables.fast_regime.KINDS`."""
        if self.solution.counts.steps == 0:  # friction could hold all the time
            return STUCK
        slider = self.description.slider
        drive = slider.k_x * abs(slider.motion.velocity * slider.direction[0])
        oscillation, own = self.transverse_oscillation, 1.0 / slider.natural_frequencies[0]
        return kind_of(self.features, self.swings, self.start, self.end, drive, oscillation, own)


def observe(description: Description, report: Callable[[float], None] | None) -> Observed:
    """Run a description, sampled as measures need it: as it says, or by its slow period."""
    start, duration = description.initial.time, description.run.duration
    slow, fast = description.slider.natural_frequencies
    along = PER_COUPLED_PERIOD * coupled_frequency(description.slider)
    least = max(PER_SLOW_PERIOD * slow, along, LEAST_SAMPLES / duration)
    wanted = description.run.sample_rate or least
    rate = min(wanted, MOST_SAMPLES / duration)
    even = sample_times(start, duration, rate)
    parts = max(ceil(PER_FAST_PERIOD * fast / rate), 1)
    steps = min(ceil(FAST_PERIODS * rate / fast), len(even) - 1)
    fine = len(even) - 1 - steps
    # from the last even samples on, each step is cut in parts
    dense = even[fine] + np.arange(steps * parts + 1) / (rate * parts)
    times = np.minimum(np.concatenate([even[:fine], dense]), start + duration)
    return Observed(description, solve(description, times, progress=report), fine, parts)


def coupled_frequency(slider: Slider) -> float:
    """Return the frequency (Hz) of the mass along the drive, if friction lets it go so only."""
    c, s = slider.direction
    return sqrt((slider.k_x * c**2 + slider.k_y * s**2) / slider.mass) / (2.0 * pi)


def seconds_of(description: Description) -> float:
    """Return about what a run takes (s), by what the paper's takes in each fast period."""
    return 1e-4 + 1.6e-6 * description.slider.natural_frequencies[1] * description.run.duration
