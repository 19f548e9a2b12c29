"""What paired times say: how much longer one takes than the other, and how sure that is."""

from __future__ import annotations

from collections.abc import Sequence
from math import comb
from statistics import median
from typing import NamedTuple

CONFIDENCE = 0.99  # of the interval: some ten cases are looked at several times each


class Ratio(NamedTuple):
    """Median of the ratios of paired times, and the interval that its true value lies in."""

    median: float
    low: float
    high: float


def ratio(now: Sequence[float], before: Sequence[float], confidence: float = CONFIDENCE) -> Ratio:
    """Return how much longer `now` takes than `before`, pair by pair.

    The interval is that of the sign test: between two of the sorted ratios, as far in as the
    binomial distribution allows. It supposes nothing about the noise but that it hits both alike;
    with too few pairs for that confidence it is that between the extremes.
    """
    ratios = sorted(a / b for a, b in zip(now, before, strict=True))
    k = _rank(len(ratios), confidence)
    return Ratio(median(ratios), ratios[k], ratios[-1 - k])


def _rank(n: int, confidence: float) -> int:
    """Return how many values may be left out at each end: P(fewer heads of n) <= half the rest."""
    outside, k = 1, 0  # heads of no coin, in 2^n ways
    while 2 * outside <= (1.0 - confidence) * 2**n:
        k += 1
        outside += comb(n, k)
    return max(0, k - 1)


def slower(found: Ratio, limit: float) -> bool | None:
    """Return whether it is slower than the limit allows; None while the interval holds it."""
    if found.low > limit:
        return True
    return None if found.high > limit else False
