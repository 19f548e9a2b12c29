"""The verdict from ratios of times: how much longer one tree takes, with a confidence interval."""

from __future__ import annotations

from collections.abc import Sequence
from math import comb
from statistics import median
from typing import NamedTuple

CONFIDENCE = 0.95  # of the interval: six ratios at least, the extremes of which it then spans


class Ratio(NamedTuple):
    """Median of several ratios of times, and the interval that their true median lies in.

    The interval is that of the sign test: it supposes nothing about the noise but that it hits both
    trees alike. It has no ends as long as there are too few ratios for one.
    """

    median: float
    low: float
    high: float


def ratio(ratios: Sequence[float], confidence: float = CONFIDENCE) -> Ratio:
    """Return the median of ratios, each from processes of its own, and its interval."""
    ordered = sorted(ratios)
    k = left_out(len(ordered), confidence)
    if k is None:
        return Ratio(median(ordered), 0.0, float("inf"))
    return Ratio(median(ordered), ordered[k], ordered[-1 - k])


def left_out(n: int, confidence: float) -> int | None:
    """Return how many of n values lie outside the interval at each end; None if n is too small.

    The true median is below the (k+1)-th smallest with the probability of at most k heads among n
    coins.
    """
    found, ways = None, 0
    for k in range(n):
        ways += comb(n, k)
        if 2 * ways > (1.0 - confidence) * 2**n:
            break
        found = k
    return found


def slower(found: Ratio, limit: float) -> bool | None:
    """Return whether it is slower than the limit allows; None while the interval holds it."""
    if found.low > limit:
        return True
    return None if found.high > limit else False
