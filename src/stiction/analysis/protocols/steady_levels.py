"""Steady friction of the stretches of a test, and its trend with the travel of the drive."""

from __future__ import annotations

from math import hypot, nan, sqrt
from typing import NamedTuple

import numpy as np

from stiction.analysis.protocols.common_mean import common_mean
from stiction.analysis.protocols.friction_test import ConstantStretch, FrictionTest
from stiction.analysis.protocols.settling import SettledPart, settled_part
from stiction.analysis.signals.correlated_noise import ERRORS_997, CorrelatedNoise, noise_about
from stiction.arrays import Floats, Indices

SLOPE = 12.0**0.5  # error of a rise in a straight line, over that of its mean
TAIL_MEAN = 0.5  # mean of what is left of an evolution in a part, over its first value, at most
SCATTERED = 3.0  # times the scatter by chance: slopes of stretches with more are not alike


class TravelTrend(NamedTuple):
    """Change of friction with the drive's travel, and its standard error in a stretch, 1/m."""

    slope: float = 0.0
    error: float = 0.0

    @property
    def stands_out(self) -> bool:
        """Whether there is a trend beyond its error."""
        return abs(self.slope) > ERRORS_997 * self.error

    @property
    def known_slope(self) -> float:
        """The slope where it stands out, 1/m; else 0."""
        return self.slope if self.stands_out else 0.0


def common_trend(slopes: Floats, errors: Floats) -> TravelTrend:
    """Return the trend that stretches have in common.

    Where their slopes scatter by more than their errors tell, the trend varies, and its error is
    that of a single one.
    """
    known = np.isfinite(slopes) & np.isfinite(errors)
    if not known.any():
        return TravelTrend()
    found = common_mean(slopes[known], errors[known])
    varies = found.variance_between if found.square > SCATTERED * found.free else 0.0
    return TravelTrend(found.value, sqrt(found.error**2 + varies))


NO_TREND, NO_NOISE = TravelTrend(), CorrelatedNoise()


class SteadyLevels(NamedTuple):
    """Steady friction of the stretches of a test, and the trend that they have in common."""

    trend: TravelTrend  # over the travel of the drive
    # of each stretch: mean friction along the drive in its settled part, its standard error, and
    # how far the drive has come there since the stretch began, m
    level: dict[ConstantStretch, float]
    error: dict[ConstantStretch, float]
    travel: dict[ConstantStretch, float]

    def at_jump(self, stretch: ConstantStretch, time: float) -> float:
        """Return the level of a stretch with the trend as it is at one of its ends."""
        return self.level[stretch] - self.trend.slope * self._since(stretch, time)

    def error_of_difference(self, one: ConstantStretch, two: ConstantStretch) -> float:
        """Return the standard error of the difference of two levels at the jump between them."""
        by_trend = self.trend.error * self.apart(one, two)
        return hypot(self.error[one], self.error[two], by_trend)

    def apart(self, one: ConstantStretch, two: ConstantStretch) -> float:
        """Return the travel from one level to the next, m."""
        return self._since(two, two.start) - self._since(one, two.start)

    def _since(self, stretch: ConstantStretch, time: float) -> float:
        return self.travel[stretch] - abs(stretch.velocity) * (time - stretch.start)


def steady_levels(test: FrictionTest) -> SteadyLevels:
    """Return steady friction of all stretches in which the mass slides.

    A run has no trend, and its levels are those of the ends of stretches.
    """
    sliding = [each for each in test.stretches if test.is_sampled(each) and test.slides(each)]
    ends = [_part(test, each, test.surely_late(each)) for each in sliding]
    if test.law is not None:
        return _levels(test, sliding, ends, NO_TREND)
    noise = noise_about([each.left for each in ends])
    rough = _trend(test, sliding, ends).slope
    parts = [_part(test, each, test.until_end(each), rough, noise) for each in sliding]
    return _levels(test, sliding, parts, _trend(test, sliding, parts))


def _part(
    test: FrictionTest,
    stretch: ConstantStretch,
    at: Indices,
    slope: float = 0.0,
    noise: CorrelatedNoise = NO_NOISE,
) -> SettledPart:
    """Return the settled part of some samples of a stretch, to its end."""
    travel = abs(stretch.velocity) * (test.time[at] - stretch.start)
    late = len(test.surely_late(stretch))
    return settled_part(travel, stretch.way * test.mu[at], late, slope, noise)


def _errors(
    test: FrictionTest, sliding: list[ConstantStretch], parts: list[SettledPart]
) -> list[float]:
    """Return the standard errors of levels without tails: by a part itself, and by all.

    A short part does not show noise that lasts longer than it.
    """
    noise = noise_about([each.left for each in parts])
    errors = []
    for each, part in zip(sliding, parts, strict=True):
        count = len(part.left)
        error = max(noise.error(count), noise_about([part.left]).own_error(count))
        errors.append(hypot(error, test.off / each.load) if count > 1 else nan)
    return errors


def _trend(
    test: FrictionTest, sliding: list[ConstantStretch], parts: list[SettledPart]
) -> TravelTrend:
    """Return the trend that settled parts have in common."""
    # of a line, the slope times the length is as uncertain as its mean times sqrt(12)
    errors = [
        hypot(SLOPE * error, part.tail) / part.length if part.length > 0.0 else nan
        for error, part in zip(_errors(test, sliding, parts), parts, strict=True)
    ]
    return common_trend(np.array([each.slope for each in parts]), np.array(errors))


def _levels(
    test: FrictionTest, sliding: list[ConstantStretch], parts: list[SettledPart], trend: TravelTrend
) -> SteadyLevels:
    """Return the levels of settled parts, and their errors."""
    errors = _errors(test, sliding, parts)
    pairs = list(zip(sliding, parts, errors, strict=True))
    return SteadyLevels(
        trend,
        {each: part.level for each, part, _ in pairs},
        {each: hypot(error, TAIL_MEAN * part.tail) for each, part, error in pairs},
        {each: part.centre for each, part, _ in pairs},
    )
