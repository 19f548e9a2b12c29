"""The kinds of motion: by the shape of a cycle, and by how much periods and drops scatter."""

from __future__ import annotations

from math import hypot, log, sqrt

import numpy as np

from stiction.analysis.motion.course import MANY, ORDERED, order
from stiction.analysis.motion.rest import STICKING, TOUCHES, rest_share, rise_share
from stiction.arrays import Floats

STICK_SLIP = "stick-slip"
TRANSITIONAL = "transitional oscillation"
HARMONIC = "harmonic vibration"
TRANSVERSE = "transverse oscillation"
IRREGULAR = "irregular vibration"
SETTLING = "settling"
STEADY = "steady sliding"
STUCK = "stuck"
UNDETERMINED = "undetermined"
# Bounds of the share of a cycle for which the mass rests, or creeps, by the cycle's shape
SHAPES = ((STICKING, STICK_SLIP), (0.5, TRANSITIONAL), (0.0, HARMONIC))
# Share of a cycle for which the mass rests or creeps, in one piece, where its slip speed is known:
# from there on it sticks and slips, whatever the shape says
RESTS = 0.5
BACKWARD = 0.4  # share of the rise, below which the force falls slowly and rises fast
# Of the period of the mass on the spring along x alone: a vibration of a lesser one has the
# transverse spring swing as well, as friction that turns couples them. On one spring friction only
# prolongs it
COUPLED = 0.9
OWN = 1.2  # times that period: up to there a vibration is that of the mass on its spring
# A vibration is irregular beyond either: the standard deviation of the periods over their mean,
# which noise through a wide filter brings to 0.37 and more; and the span of the drops over their
# median, a tenth left out at each end. Noise through any filter has 1.4 of it, as amplitudes of
# Rayleigh's distribution have, 0.7 to 1.5 where records are short; a measured vibration of one size
# has 0.57.
REGULAR, EVEN = 0.25, 0.75
SPREAD_ERROR = 1.8  # over the root of the number of swings: relative error of either
# That span of irregular vibrations, and of harmonic ones, measured among them, whose swings differ
# by noise or slowly: the typical one, and the standard deviation of its logarithm
IRREGULAR_SPREAD, HARMONIC_SPREAD = (1.05, 0.1), (0.17, 0.8)


def shape(rise_share: float, still: float = 0.0, sticks: float = 0.0) -> str:
    """Return the kind of cycles from the shares of rise, and of rest and sticking where known."""
    if still >= RESTS or sticks > TOUCHES:
        return STICK_SLIP
    if rise_share < BACKWARD:
        return UNDETERMINED
    rests = rest_share(rise_share)
    return next(kind for bound, kind in SHAPES if rests >= bound)


def bounds(kind: str) -> tuple[float, float]:
    """Return the bounds of the rise share for a kind of cycle."""
    if kind == UNDETERMINED:
        return -np.inf, BACKWARD
    ends = [np.inf, *(float(rise_share(rests)) for rests, _ in SHAPES[:-1]), BACKWARD]
    place = [name for _, name in SHAPES].index(kind)
    return ends[place + 1], ends[place]


def couples(kind: str, period: float, own: float) -> bool:
    """Return whether a vibration is too quick for the spring along x, whose period is `own`.

    Then the transverse spring swings as well: friction that turns couples them. Where the mass
    sticks, it does so once in each of these swings.
    """
    return kind in (TRANSITIONAL, HARMONIC) and period < COUPLED * own


def drop_spread(drop: Floats) -> float:
    """Return the span of the drops over their median, a tenth left out at each end."""
    low, middle, high = np.percentile(drop, (10.0, 50.0, 90.0))
    return float((high - low) / middle)


def irregularity(period: Floats, drop: Floats) -> float:
    """Return the likelihood of irregular swings from the spread of their periods and drops.

    By periods: whether more swings would exceed the spread `REGULAR`. By drops: their spread is
    drawn from one of two distributions, of which that of irregular swings narrows with the number
    of swings; where both overlap, `EVEN` decides. Sizes in order grow or shrink; they say nothing.
    """
    from scipy.special import expit, ndtr

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
    return max(likely, max(drops, 0.5) if spread > EVEN else min(drops, 0.5))


def _log_density(value: float, typical: float, spread: float) -> float:
    """Return the logarithm of the density of a value's logarithm, normal about a typical one's."""
    return -0.5 * (log(value / typical) / spread) ** 2 - log(spread)
