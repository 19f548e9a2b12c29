"""Vibrations: their period beside that of the mass on its spring, and their irregularity."""

from __future__ import annotations

from math import hypot, log, pi, sqrt
from typing import NamedTuple

import numpy as np

from stiction.analysis.motion.changes.cycles import stand_apart
from stiction.analysis.motion.course import MANY, ORDERED, order
from stiction.arrays import Floats
from stiction.drive.program import nominal_velocity
from stiction.system.slider import Slider

# Of the period of the mass on the spring along x alone: a vibration of a lesser one has the
# transverse spring swing as well, as friction that turns couples them. On one spring friction only
# prolongs it
COUPLED = 0.9
OWN_PERIODS = 1.2  # times that period: up to there a vibration is that of the mass on its spring
# A vibration is irregular beyond either: the standard deviation of the periods over their mean,
# which noise through a wide filter brings to 0.37 and more; and the span of the drops over their
# median, a tenth left out at each end. Noise through any filter has 1.4 of it, as amplitudes of
# Rayleigh's distribution have, 0.7 to 1.5 where records are short; a measured vibration of one size
# has 0.57.
REGULAR, EVEN_DROPS = 0.25, 0.75
LIKELY = 0.5  # likelihood above which swings are irregular
SPREAD_ERROR = 1.8  # over the root of the number of swings: relative error of either
# That span of irregular vibrations, and of harmonic ones, measured among them, whose swings differ
# by noise or slowly: the typical one, and the standard deviation of its logarithm
IRREGULAR_SPREAD, HARMONIC_SPREAD = (1.05, 0.1), (0.17, 0.8)

LEAST_OSCILLATION = 0.1  # of the largest amplitude of the fast oscillation without reversal of slip
FAST_PERIODS = 32  # of the fast oscillation at the end, over which it is measured


class FastOscillation(NamedTuple):
    """The fast oscillation at the end of a run."""

    # of the rate along the stiffer axis, over the drive's velocity along it: at most 1 unless the
    # slip reverses (Nakano & Popov, below Eq. (9))
    amplitude: float
    rate: float  # that amplitude times the lesser stiffness, N/s

    @classmethod
    def at_end(cls, slider: Slider, rate: Floats) -> FastOscillation:
        """Return a run's fast oscillation from its last rates (m/s) along the stiffer axis."""
        drive = abs(nominal_velocity(slider.motion) * slider.direction[slider.stiffer_axis])
        across = 0.5 * float(np.ptp(rate))
        amplitude = across / drive if drive > 0.0 else 0.0
        return cls(amplitude, min(slider.k_x, slider.k_y) * across)

    def goes_on(self, drop: float = 0.0, period: float = 1.0) -> bool:
        """Return whether it goes on by itself.

        A last swing of a force, of a drop (N) in a period (s), which dies out, sets the stiffer
        spring in motion, too.
        """
        return self.amplitude > LEAST_OSCILLATION and pi * drop / period <= self.rate


def drop_spread(drop: Floats) -> float:
    """Return the span of the drops over their median, a tenth left out at each end."""
    low, middle, high = np.percentile(drop, (10.0, 50.0, 90.0))
    return float((high - low) / middle)


def is_irregular(period: Floats, drop: Floats) -> bool:
    """Return whether swings are irregular rather than harmonic."""
    return irregularity(period, drop) > LIKELY


def irregularity(period: Floats, drop: Floats) -> float:
    """Return the likelihood of irregular swings from the spread of their periods and drops.

    By periods: whether more swings would exceed the spread `REGULAR`. By drops: their spread is
    drawn from one of two distributions, of which that of irregular swings narrows with the number
    of swings; where both overlap, `EVEN_DROPS` decides. Sizes in order grow or shrink; they say
    nothing. Nor do a few swings far above all others, such as a knock.
    """
    from scipy.special import expit, ndtr

    usual = ~(stand_apart(period) | stand_apart(drop))
    period, drop = period[usual], drop[usual]
    count, likely = len(drop), 0.0
    if count < MANY or abs(order(period)) < -ORDERED:
        spread = float(period.std() / period.mean()) / REGULAR
        likely = float(ndtr(log(max(spread, 1e-9)) * sqrt(count) / SPREAD_ERROR))
    spread = drop_spread(drop)
    if abs(order(drop)) >= -ORDERED or spread == 0.0:  # it grows, or is quite even
        return likely
    error = hypot(SPREAD_ERROR / sqrt(count), IRREGULAR_SPREAD[1])
    drops = float(
        expit(
            _log_density(spread, IRREGULAR_SPREAD[0], error)
            - _log_density(spread, *HARMONIC_SPREAD)
        )
    )
    return max(likely, max(drops, 0.5) if spread > EVEN_DROPS else min(drops, 0.5))


def _log_density(value: float, typical: float, spread: float) -> float:
    """Return the logarithm of the density of a value's logarithm, normal about a typical one's."""
    return -0.5 * (log(value / typical) / spread) ** 2 - log(spread)
