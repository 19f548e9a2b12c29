"""Means of correlated values, and noise that lasts for several samples."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from typing import NamedTuple

import numpy as np

from stiction.arrays import Floats

CORRELATED = 8  # values: of fewer no correlation is known
BOUNDS_95 = (0.025, 0.975)  # quantiles, between which 95 % of all values lie
ERRORS_95, ERRORS_997 = 2.0, 3.0  # standard errors to each side, which hold 95 % and 99.7 %
FEWEST = 3  # samples that deviate from a straight line
# Of the time that noise lasts, times its share of a series: what the series does not show of it;
# found with noise of exponential correlation, where 4 to 11 are missing
UNSEEN = 8.0


def interval_95(values: Floats) -> Floats:
    """Return the ends (2, ...) of the interval with 95 % of a population, from draws (n, ...).

    They are median-unbiased, whatever the distribution (R. J. Hyndman & Y. Fan, Am. Stat. 50, 361
    (1996)). Interpolated from the smallest to the largest value, those of 64 hold 93 % of others.

    >>> interval_95((np.arange(64) + 0.5) / 64).round(2)
    array([0.02, 0.98])
    """
    return np.asarray(np.quantile(values, BOUNDS_95, axis=0, method="median_unbiased"))


def correlation_time(values: Floats) -> float:
    """Return the integrated autocorrelation time of evenly spaced values, at least 1.

    So many in succession count as one independent value. It is twice the sum of the
    autocorrelations, less 1, as far as pairs of them are positive (C. J. Geyer, Stat. Sci. 7, 473
    (1992)). Values that alternate count as independent, and so do a few.

    >>> correlation_time(np.tile([1.0, -1.0], 10))
    1.0
    """
    count, left = len(values), values - values.mean() if len(values) else values
    if count < CORRELATED or not left.any():
        return 1.0
    from scipy.fft import irfft, rfft

    power = np.abs(rfft(left, 2 * count)) ** 2
    share = irfft(power)[: count // 2]
    share = share[: len(share) // 2 * 2].reshape(-1, 2).sum(axis=1) / share[0]
    ends = np.flatnonzero(share <= 0.0)
    return max(2.0 * float(share[: ends[0] if len(ends) else None].sum()) - 1.0, 1.0)


def whole_correlation_time(deviations: Floats) -> float:
    """Return the correlation time of noise, from deviations from straight lines.

    A line follows a part of noise that lasts.
    """
    seen = correlation_time(deviations)
    return seen * (1.0 + UNSEEN * seen / len(deviations))


def mean_and_spread(values: Floats) -> tuple[float, float]:
    """Return mean and standard deviation of values."""
    return float(values.mean()), float(values.std(ddof=1)) if len(values) > 1 else np.nan


def statistics(values: Floats) -> tuple[float, float, float]:
    """Return mean, standard error and spread of values that may be correlated.

    `error_of_few` makes that of few values larger.
    """
    mean, spread = mean_and_spread(values)
    independent = len(values) / correlation_time(values)
    return mean, float(error_of_few(spread / independent**0.5, independent - 1.0)), spread


def error_of_few(error: float, freedom: float) -> float:
    """Return a standard error, larger for few values, so that twice this error holds 95 %.

    The quantile of Student's t with so many degrees of freedom, over two, and at least 1.

    >>> round(error_of_few(1.0, 2), 2), error_of_few(1.0, 1000)
    (2.15, 1.0)
    """
    from scipy.special import stdtrit

    return error * max(1.0, 0.5 * float(stdtrit(max(freedom, 1.0), BOUNDS_95[1])))


def standard_error(values: Floats) -> float:
    """Return the standard error of the mean of values that may be correlated."""
    return statistics(values)[1]


class CorrelatedNoise(NamedTuple):
    """Standard deviation of noise, and how many samples count as one that is independent."""

    deviation: float = 0.0
    samples: float = 1.0
    few: float = 1.0  # factor of an error that is known by few of them

    def error(self, count: int) -> float:
        """Return the standard error of a mean over so many samples in succession."""
        return self.few * self.deviation * sqrt(self.samples / (count + self.samples - 1.0))

    def own_error(self, count: int) -> float:
        """Return the error by the observed noise alone, without a factor for few samples."""
        return self.error(count) / self.few


def noise_about(parts: Sequence[Floats]) -> CorrelatedNoise:
    """Return the noise of deviations from straight lines, in several parts in a row."""
    left = np.concatenate([np.empty(0), *parts])
    count = len(left)
    if count < FEWEST:
        return CorrelatedNoise()
    samples = whole_correlation_time(left)
    free = count / samples - 2.0 * len(parts)
    # parts of few independent values deviate less from their own lines
    deviation = sqrt(float(left @ left) / count * (1.0 + 2.0 * len(parts) / max(free, 1.0)))
    return CorrelatedNoise(deviation, samples, error_of_few(1.0, free))
