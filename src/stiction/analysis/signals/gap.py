"""The gap between small and large heights of reversals.

A random walk has no gap: of n reversals higher than a, n (a/b)^2 are higher than b on average,
for any a < b, since it is self-similar; noise without memory falls off faster. More reversals above
b therefore indicate two populations, the more clearly the less likely a random walk is to have so
many. No threshold is set by hand.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from stiction.arrays import Floats

PER_OCTAVE = 4  # edges tried in each factor of two of height
# A walk of steps of finite size goes beyond a level before it turns: at either end by 0.583
# standard deviations of a step (Siegmund 1985, Sequential Analysis), of which its median is 0.674.
OVERSHOOT = 2 * 0.583 / 0.674
# What a gap must be worth for each of those above it: as much as an empty one of a factor 2^(1/2).
# The random walk is no exact model of any noise, and its faults would add up over thousands.
EACH = np.log(2.0)


class Gap(NamedTuple):
    """The gap between small and large.

    Parameters
    ----------
    low, high : float
        Ends of the gap.
    clearness : float
        Minus the logarithm of (a bound of) the probability that a random walk has as many above
        it.
    """

    low: float
    high: float
    clearness: float

    @property
    def middle(self) -> float:
        """The middle of the gap on a logarithmic scale."""
        return float(np.sqrt(self.low * self.high))


NO_GAP = Gap(0.0, 0.0, 0.0)


def widest_gap(heights: ArrayLike, step: float, most: float) -> Gap:
    """Return the gap that is least likely in a random walk.

    Parameters
    ----------
    heights : array
        (n,) heights of reversals.
    step : float
        Resolution of the heights; gaps are sought above two steps.
    most : float
        Largest number of large heights.
    """
    size = np.sort(np.asarray(heights, dtype=np.float64))
    lowest = 2.0 * step
    if len(size) == 0 or not size[-1] > lowest > 0.0:
        return NO_GAP
    octaves = np.log2(size[-1] / lowest)
    edges = np.geomspace(lowest, size[-1], int(np.ceil(PER_OCTAVE * octaves)) + 1)
    edges[-1] = size[-1]
    low, high = np.triu_indices(len(edges), 1)
    # counted one step lower, so that the steps of a digitised signal are not taken for gaps
    above_low = (len(size) - np.searchsorted(size, edges - step))[low]
    above_high = (len(size) - np.searchsorted(size, edges))[high]
    share = ((edges[low] + OVERSHOOT * step) / (edges[high] + OVERSHOOT * step)) ** 2
    worth = _surprise(above_high, above_low, share)
    worth[(above_low > most) | (worth < EACH * above_high)] = 0.0
    best = int(np.argmax(worth))
    return Gap(float(edges[low[best]]), float(edges[high[best]]), float(worth[best]))


def _surprise(found: ArrayLike, among: ArrayLike, chance: ArrayLike) -> Floats:
    """Return a lower bound of -log P(at least `found` of `among`), each with a `chance`.

    Chernoff's bound of the binomial distribution: among times the Kullback-Leibler divergence.
    """
    from scipy.special import rel_entr

    n, q = np.asarray(among, dtype=np.float64), np.asarray(chance, dtype=np.float64)
    share = np.asarray(found) / np.maximum(n, 1.0)
    worth: Floats = n * (rel_entr(share, q) + rel_entr(1.0 - share, 1.0 - q))
    return np.where(share > q, worth, 0.0)
