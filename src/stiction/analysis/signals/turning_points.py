"""Turning points of a signal: peaks and troughs that stand apart from noise and ripple.

They do so by a gap between small and large heights of reversals. A random walk has no gap: of n
reversals higher than a, n (a/b)^2 are higher than b on average, for any a < b, since it is
self-similar; noise without memory falls off faster. More reversals above b therefore indicate two
populations, the more clearly the less likely a random walk is to have so many. No threshold is set
by hand.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiction.analysis.signals.reversals import (
    Counts,
    all_heights,
    extrema,
    remove_reversals,
    standing_out,
)
from stiction.analysis.signals.robust import median_of_three
from stiction.arrays import Floats, Indices, compute_once, median

PER_OCTAVE = 4  # edges tried in each factor of two of height
# A walk of steps of finite size goes beyond a level before it turns: at either end by 0.583
# standard deviations of a step (Siegmund 1985, Sequential Analysis), of which its median is 0.674.
OVERSHOOT = 2 * 0.583 / 0.674
# What a gap must be worth for each of those above it: as much as an empty one of a factor 2^(1/2).
# The random walk is not an exact model of any noise, and its faults would add up over thousands.
EACH = np.log(2.0)
Number = TypeVar("Number", np.int64, np.float64)

COUNTS = 2**26  # over a signal's range; sums over 2^30 samples still fit into 64 bits
FEWEST_PER_CYCLE = 8  # samples of a cycle; with fewer, no shape can be seen
COARSE_TURNS = 12  # turning points of cycles of few samples: at least so many are needed
# The smaller legs over the larger ones, the tenths beyond left out; 0.08 for noise
ALIKE_LEGS = 0.5
EVEN_PERIODS = 0.3  # standard deviation of the periods over their mean
AS_GOOD = 0.9  # of the clearest gap: of two levels as good, the finer one places points better
PLACING = 1 / 16  # of a leg: with noise below this the finest level places a corner best
# A gap found by chance: some 20 levels times 20 octaves are tried, so that exp(-12) each leaves
# one false alarm in 400 records of a random walk at most.
CLEAR = 12.0


class Gap(NamedTuple):
    """The gap between small and large."""

    # ends of the gap
    low: float
    high: float
    # minus the logarithm of (a bound of) the probability that a random walk has as many above it
    clearness: float

    @property
    def middle(self) -> float:
        """The middle of the gap on a logarithmic scale."""
        return float(np.sqrt(self.low * self.high))


NO_GAP = Gap(0.0, 0.0, 0.0)


def widest_gap(heights: ArrayLike, step: float, most: float) -> Gap:
    """Return the gap that is least likely in a random walk.

    Heights are those of reversals, with a resolution of `step`: gaps are sought above two of these.
    There are at most so many large ones as `most`.
    """
    size = np.sort(np.asarray(heights, dtype=np.float64))
    lowest = 2.0 * step
    if len(size) == 0 or not size[-1] > lowest > 0.0:
        return NO_GAP
    octaves = np.log2(size[-1] / lowest)
    count = int(np.ceil(PER_OCTAVE * octaves)) + 1
    # what `geomspace` does, which looks longer at its arguments than at the edges
    edges = 10.0 ** np.linspace(np.log10(lowest), np.log10(size[-1]), count)
    edges[0], edges[-1] = lowest, size[-1]
    # counted one step lower, so that the steps of a digitised signal are not taken for gaps
    above_low = len(size) - np.searchsorted(size, edges - step)
    above_high = len(size) - np.searchsorted(size, edges)
    few = np.flatnonzero(above_low[:-1] <= most)
    if not few.size:
        return NO_GAP
    first = few[0]  # from there on all are few enough
    low, high = first + pairs_of(len(edges) - first)
    share = ((edges[low] + OVERSHOOT * step) / (edges[high] + OVERSHOOT * step)) ** 2
    worth = surprise(above_high[high], above_low[low], share)
    worth[worth < EACH * above_high[high]] = 0.0
    best = int(np.argmax(worth))
    return Gap(float(edges[low[best]]), float(edges[high[best]]), float(worth[best]))


@cache
def pairs_of(count: int) -> Indices:
    """Return the lower and the higher place of each pair of so many, (2, n)."""
    return np.array(np.triu_indices(count, 1))


def surprise(found: ArrayLike, among: ArrayLike, chance: ArrayLike) -> Floats:
    """Return a lower bound of -log P(at least `found` of `among`), each with a `chance`.

    Chernoff's bound of the binomial distribution: among times the Kullback-Leibler divergence.
    """
    from scipy.special import rel_entr

    n, q = np.asarray(among, dtype=np.float64), np.asarray(chance, dtype=np.float64)
    share = np.asarray(found) / np.maximum(n, 1.0)
    worth: Floats = n * (rel_entr(share, q) + rel_entr(1.0 - share, 1.0 - q))
    return np.where(share > q, worth, 0.0)


class TurningPoints(NamedTuple):
    """Alternating troughs and peaks, and the averaged signal in which they were found."""

    # (n,) index of each in `values`
    index: Indices  # type: ignore[assignment]  # a tuple's index(), which nobody needs here
    trough: NDArray[np.bool_]  # (n,) whether it is a trough
    values: Floats  # means of the signal over `width` samples each, without wild ones
    width: int  # 1, 2, 4, ...
    noise: float  # how far noise reaches in `values`, see `noise_reach`
    clearness: float  # clearness of the gap to all smaller reversals, see `widest_gap`
    # height of that gap's middle, in the unit of the values: smaller reversals are not seen
    least: float = 0.0

    @property
    def before(self) -> float:
        """The signal's extreme before the first point, farthest from it."""
        values = self.values[: self.index[0] + 1]
        return float(values.max() if self.trough[0] else values.min())

    @property
    def after(self) -> float:
        """The signal's extreme after the last point, farthest from it."""
        values = self.values[self.index[-1] :]
        return float(values.max() if self.trough[-1] else values.min())


def turning_points(values: Floats) -> TurningPoints:
    """Find the peaks and troughs of the movements that stand apart from all smaller ones.

    The signal is averaged over 1, 2, 4, 8 ... samples. At each level the gap between small and
    large heights of reversals is sought; the level with the clearest gap decides. If none is clear,
    there are no points.
    """
    counts = limit_spikes(as_counts(values))
    levels = list(running_sums(counts))
    steps = [typical_step(each) / 2**level for level, each in enumerate(levels)]
    gaps = [
        widest_gap(all_heights(each) / 2**level, max(steps[0], step), len(each) / FEWEST_PER_CYCLE)
        for level, (each, step) in enumerate(zip(levels, steps, strict=True))
    ]
    clearest = max((gap.clearness for gap in gaps), default=0.0)
    if clearest < CLEAR and len(few := coarse_points(counts)):
        rising = np.diff(counts[few], prepend=counts[0]) < 0
        return TurningPoints(few, rising, values, 1, 0.0, CLEAR)
    none = np.zeros(0, np.intp)
    nothing = TurningPoints(none, none.astype(bool), values, 1, 0.0, clearest)
    if clearest < CLEAR:
        return nothing
    level = next(i for i, gap in enumerate(gaps) if gap.clearness >= AS_GOOD * clearest)
    gap, width = gaps[level], 2**level
    index = standing_out(levels[level], gap.middle * width, gap.low * width)
    if len(index) < 2:  # one turn is not a cycle
        return nothing
    leg = median(np.abs(np.diff(levels[level][index]))) / width
    trough = np.diff(levels[level][index], append=0) > 0
    trough[-1:] = ~trough[-2:-1]
    for quiet in range(level + 1):
        reach = noise_reach(levels[quiet], gap.middle * 2**quiet) / 2**quiet
        if reach < PLACING * leg:
            break
    for finer in range(level - 1, quiet - 1, -1):
        index = _locate(levels[finer], index, trough)
    unit = float(np.ptp(values)) / COUNTS
    means = values.min() + unit / 2**quiet * levels[quiet] if quiet else without_spikes(values)
    noise, least = unit * reach, unit * gap.middle
    return TurningPoints(index, trough, means, 2**quiet, noise, gap.clearness, least)


def coarse_points(counts: Counts) -> Indices:
    """Return the turning points of cycles of few samples each; none unless nearly all are alike.

    With so few samples there are no smaller reversals to compare with. But noise has reversals of
    every height, and cycles have only one.
    """
    found = extrema(counts)[1:-1]
    if len(found) < COARSE_TURNS:
        return found[:0]
    legs = np.abs(np.diff(counts[found]))
    small, large = np.percentile(legs, (10.0, 90.0))
    period = found[2:] - found[:-2]
    alike = small > ALIKE_LEGS * large and period.std() < EVEN_PERIODS * period.mean()
    return found if alike else found[:0]


def _locate(counts: Counts, index: Indices, trough: NDArray[np.bool_]) -> Indices:
    """Return where the turning points of the sums of two are in `counts`, in the same order.

    Each is sought among six samples, those nearer to the next point left out.
    """
    middle = index[:-1] + index[1:]
    first, last = np.append(0, middle + 1), np.append(middle, len(counts) - 1)
    around = np.clip(2 * index[:, None] + np.arange(-2, 4), first[:, None], last[:, None])
    upward = np.where(trough, -1, 1)[:, None] * counts[around]
    return np.take_along_axis(around, np.argmax(upward, axis=1)[:, None], axis=1)[:, 0]


def as_counts(values: Floats) -> Counts:
    """Return the values as whole numbers, 0 to `COUNTS`, so that ties are ties in any unit."""
    if len(values) == 0 or np.ptp(values) == 0.0:
        return np.zeros(len(values), np.int64)
    counts: Counts = np.rint((values - values.min()) / np.ptp(values) * COUNTS).astype(np.int64)
    return counts


def limit_spikes(values: NDArray[Number]) -> NDArray[Number]:
    """Limit each sample to the extrapolation of its neighbours; smooth peaks stay."""
    limited = values.copy()
    if len(values) < 5:
        return limited
    before, after = values[1:-3], values[3:-1]
    rising, falling = 2 * before - values[:-4], 2 * after - values[4:]
    low = np.minimum(np.minimum(before, after), np.minimum(rising, falling))
    high = np.maximum(np.maximum(before, after), np.maximum(rising, falling))
    limited[2:-2] = np.clip(values[2:-2], low, high)
    return limited


@compute_once
def without_spikes(values: Floats) -> Floats:
    """Return a signal after `limit_spikes`: an array that cannot be changed.

    All that look at a record's force share it, and so what is found once of each array.
    """
    found = limit_spikes(values)
    found.setflags(write=False)
    return found


def running_sums(counts: Counts) -> Iterator[Counts]:
    """Yield the signal, then its sums over 2, 4, 8 ... samples, single wild ones replaced."""
    while len(counts) >= 2 * FEWEST_PER_CYCLE:
        yield counts
        pairs = counts[: len(counts) // 2 * 2].reshape(-1, 2).sum(axis=1)
        counts = pairs.copy()
        counts[1:-1] = median_of_three(pairs[:-2], pairs[1:-1], pairs[2:])


def typical_step(counts: Counts) -> float:
    """Return the median difference of two samples in succession that differ at all."""
    steps = np.abs(np.diff(counts))
    return median(steps[steps > 0]) if steps.any() else 0.0


def noise_reach(counts: Counts, height: float) -> float:
    """Return how far noise reaches, from the reversals smaller than `height`.

    White noise turns back in two of three samples: six times the sum of its reversals, divided by
    the number of samples, is then about two standard deviations. Where only a few samples turn
    back, as in a smooth signal with a ripple here and there, it is nearly nothing.
    """
    _, heights = remove_reversals(counts, height)
    return 6.0 * float(heights.sum()) / max(len(counts), 1)
