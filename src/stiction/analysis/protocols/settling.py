"""Whether a force has settled in the end of a stretch in which nothing is changed; its trend."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, hypot, isnan, nan, sqrt
from typing import NamedTuple

import numpy as np

from stiction.analysis.signals.robust import correlation_time, error_of_few, part_means
from stiction.arrays import TINY, Floats

SETTLED = 0.2  # of a stretch: its end, in which friction counts as steady
# Of the drive's speed, at which the spring is still loaded: a mass that rests has 1, one that
# slides 0. One that breaks away in the end of the stretch, after a share f of it, has f^2 (3 - 2f):
# at 0.1 the mean force there is too small by 0.4 % of the loading in a whole stretch. A vibration
# of fewer than three cycles there may have as much, and its mean is as uncertain.
RESTS = 0.1
# Of the force's change within a stretch. Where it tends to its value exponentially, its mean in the
# end of the stretch is off by as much as it still changes there, within a factor of two.
CHANGES = 0.01
ROUNDED = 1e-5  # of the force: a change that an accurate solution may have
BLOCKS = 8  # means of the end of a stretch, that noise and vibrations are known by
CERTAIN = 5.96  # standard errors, Student's t with 6 degrees of freedom: by chance 1 in 1000
PARTS = 50  # of a stretch: their means show how far friction evolves
LAST = 10  # of these: the end of a stretch, SETTLED
EVOLVED = 0.1  # of all change in a stretch: what is left where evolution is nearly over
STANDS_OUT = 4.0  # standard deviations: 1 of 300 series of 50 means has one beyond by chance
# Travels over which it evolves to that, after which it is over: tails are of D_c, which the travel
# is 1.5 times (ageing law, to a tenth of the speed) to 3.6 times (to ten times the speed)
OVER = 4.0
TAIL = 1.5  # e-folds of a tail within that travel, at least
BENT = 2.0  # standard errors of a bend: a part that has more is no straight line
FEWEST = 3  # samples that deviate from a straight line
# Of the time that noise lasts, times its share of a series: what the series does not show of it;
# found with noise of exponential correlation, where 4 to 11 are missing
UNSEEN = 8.0
SURE = 3.0  # standard errors beyond which there is a trend
SCATTERED = 3.0  # times the scatter by chance: slopes of stretches with more are not alike


def has_settled(time: Floats, force: Floats, late: int) -> bool:
    """Return whether a force over a stretch has settled in its last samples, `late` in number.

    It has not if it still changes there, for sure and by more than a small share of all its change
    in the stretch. While a spring is loaded that is a fifth.
    """
    rise = line(*_blocks(time[-late:], force[-late:]))
    change = abs(rise.slope) * float(time[-1] - time[-late])
    least = max(CHANGES * float(np.ptp(force)), ROUNDED * float(np.abs(force).max()))
    return not (abs(rise.slope) > CERTAIN * rise.slope_error and change > least)


def _blocks(time: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return means of equally many neighbours, at most some few."""
    count = min(BLOCKS, len(time))
    parts = [np.array_split(each, count) for each in (time, values)]
    times, means = (np.array([float(part.mean()) for part in each]) for each in parts)
    return times, means


class StraightLine(NamedTuple):
    """A straight line through points, and the standard errors of its two numbers."""

    slope: float
    offset: float
    slope_error: float = nan
    offset_error: float = nan

    def deviations(self, x: Floats, y: Floats) -> Floats:
        """Return what points deviate by from the line."""
        return y - self.offset - self.slope * x


def trend(x: Floats, y: Floats, errors: Floats) -> StraightLine:
    """Return the line through few points, with errors by their scatter and by their own.

    Scatter tells two numbers by few values, see `error_of_few`; with fewer than three points the
    errors are NaN.
    """
    found = line(x, y)
    if isnan(found.slope_error):
        return found
    away = x - x.mean()
    share = away / (away @ away)
    weights = share, 1.0 / len(x) - x.mean() * share
    by_scatter = (error_of_few(each, len(x) - 2.0) for each in found[2:])
    by_points = (float(np.linalg.norm(each * errors)) for each in weights)
    return StraightLine(*found[:2], *map(hypot, by_scatter, by_points))


def line(x: Floats, y: Floats) -> StraightLine:
    """Return the least-squares line; NaN where a number is unknown."""
    away = x - x.mean()
    spread = float((away**2).sum())
    if len(x) < 2 or spread == 0.0:
        return StraightLine(nan, nan)
    slope = float((away * (y - y.mean())).sum()) / spread
    offset = float(y.mean() - slope * x.mean())
    if len(x) < 3:
        return StraightLine(slope, offset)
    found = StraightLine(slope, offset)
    variance = float((found.deviations(x, y) ** 2).sum()) / (len(x) - 2)
    of_offset = variance * (1.0 / len(x) + x.mean() ** 2 / spread)
    return found._replace(slope_error=sqrt(variance / spread), offset_error=sqrt(of_offset))


class SettledPart(NamedTuple):
    """Friction after it has evolved in a stretch, as a straight line over the drive's travel.

    Attributes
    ----------
    centre, length : float
        Mean travel since the stretch began, and travel within the part, m.
    level, slope : float
        Mean friction, and its change with the travel, 1/m.
    left : ndarray
        (n,), what samples deviate by from the line.
    tail : float
        What may be left of the evolution where the part begins.
    """

    centre: float
    length: float
    level: float
    slope: float
    left: Floats
    tail: float


def settled_part(
    travel: Floats, mu: Floats, late: int, slope: float, noise: CorrelatedNoise
) -> SettledPart:
    """Return the settled part of a stretch, its last samples (`late` in number) at least.

    It begins some travels after the last that deviates from the line of the end, and later where
    it is bent. What deviates is seen less a slope, and beyond noise, that are known roughly.
    """
    count = len(mu)
    means = part_means(mu - slope * travel, PARTS)
    off = np.abs(means - means[-LAST * len(means) // PARTS :].mean())
    seen = max(EVOLVED * off.max(), STANDS_OUT * noise.error(-(-count // PARTS)))
    gone = float(np.flatnonzero(off > seen)[-1] + 1) / len(means) if (off > seen).any() else 0.0
    latest = max(count - late, 0)
    first = min(int(OVER * gone * count), latest)
    while first < latest and _is_bent(mu[first:]):
        first = (first + latest + 1) // 2
    tail = 0.0
    if gone:
        tail = EVOLVED * float(off.max()) * exp(min(-TAIL * (first / count / gone - 1.0), 0.0))
    x, y = travel[first:], mu[first:]
    found = line(x, y).slope
    left = y - y.mean() - found * (x - x.mean())
    return SettledPart(
        float(x.mean()), float(x[-1] - x[0]), float(y.mean()), float(found), left, tail
    )


def _is_bent(mu: Floats) -> bool:
    """Return whether friction of evenly sampled travel is not a straight line, beyond its noise."""
    means = part_means(mu, PARTS)
    if len(means) < BLOCKS:
        return False
    x = np.linspace(-1.0, 1.0, len(means))
    columns = np.stack([np.ones(len(x)), x, x**2 - np.mean(x**2)], axis=1)
    found = np.linalg.lstsq(columns, means, rcond=None)[0]
    left = means - columns @ found
    variance = correlation_time(left) * float(left @ left) / (len(x) - 3)
    error = sqrt(variance / float(columns[:, 2] @ columns[:, 2]))
    return bool(abs(found[2]) > BENT * error)


class CorrelatedNoise(NamedTuple):
    """Standard deviation of noise, and how many samples count as one that is independent."""

    deviation: float = 0.0
    samples: float = 1.0
    few: float = 1.0  # factor of an error that is known by few of them

    def error(self, count: int) -> float:
        """Return the standard error of a mean over so many samples in succession."""
        return self.few * self.deviation * sqrt(self.samples / (count + self.samples - 1.0))

    def own_error(self, count: int) -> float:
        """Return the same by what is seen alone: there may be too few samples to see it."""
        return self.error(count) / self.few


def noise_about(parts: Sequence[Floats]) -> CorrelatedNoise:
    """Return the noise that deviations from straight lines show: those of some parts in a row."""
    left = np.concatenate([np.empty(0), *parts])
    count = len(left)
    if count < FEWEST:
        return CorrelatedNoise()
    samples = correlation_time(left)
    samples *= 1.0 + UNSEEN * samples / count
    free = count / samples - 2.0 * len(parts)
    # parts of few independent values deviate less from their own lines
    deviation = sqrt(float(left @ left) / count * (1.0 + 2.0 * len(parts) / max(free, 1.0)))
    return CorrelatedNoise(deviation, samples, error_of_few(1.0, free))


class TravelTrend(NamedTuple):
    """Change of friction with the drive's travel, and its standard error in a stretch, 1/m."""

    slope: float = 0.0
    error: float = 0.0

    @property
    def stands_out(self) -> bool:
        """Whether there is a trend beyond its error."""
        return abs(self.slope) > SURE * self.error


def common_trend(slopes: Floats, errors: Floats) -> TravelTrend:
    """Return the trend that stretches have in common.

    Where their slopes scatter by more than their errors tell, the trend varies, and its error is
    that of a single one (R. DerSimonian & N. Laird, Control. Clin. Trials 7, 177 (1986)).
    """
    known = np.isfinite(slopes) & np.isfinite(errors)
    slopes, weights = slopes[known], errors[known].clip(TINY) ** -2.0
    if not len(slopes):
        return TravelTrend()
    total, free = float(weights.sum()), len(slopes) - 1
    slope = float(weights @ slopes) / total
    square, varies = float(weights @ (slopes - slope) ** 2), 0.0
    if square > SCATTERED * free:
        varies = (square - free) / (total - float(weights @ weights) / total)
    return TravelTrend(slope, sqrt(1.0 / total + varies))
