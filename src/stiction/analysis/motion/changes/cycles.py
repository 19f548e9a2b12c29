"""Changes among cycles: parts of their own, a build-up, a rate of loading, cycles apart."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiction.analysis.motion.course import ORDERED, order
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.arrays import TINY, Floats, median
from stiction.recording.noise import white_noise

FEW_CYCLES = 4  # in each part
CHANGED = 0.25  # logarithm of the ratio of two periods, or rates: a quarter more or less
# Of a split of a constant period with noise, the gain in the sum of squares over the variance is
# larger than that once in a thousand records of up to a thousand cycles
LEAST_GAIN = 20.0
# A cycle apart: times the median, and its distance from it over the span of the others, a tenth of
# these left out at each end where there are many; of measured stick-slip the largest comes to 1.4
FAR, BEYOND, FEWEST_CYCLES, MANY = 2.0, 5.0, 5, 10
RARE = 4  # one in so many at most
# Swings that build up: less than half the median, so many in succession (by chance once in a
# thousand records where a quarter of all are so small)
BELOW, BUILDING = 0.5, 5
# Large and small drops in turn: share of the large ones that exceed both neighbours, of which
# independent drops have a third, so that it is by chance in one of 2000 records; how many there
# are at least; and the large ones over the small ones
IN_TURN, FEWEST_LARGE, LARGER = 0.9, 10, 1.2
# A small slip in each cycle: share of the cycles, and spread of the slips over their mean
IN_EACH, EVEN_SLIPS = 0.9, 0.25
GROWN = 0.1  # logarithm of the last over the first of some that grow, in order


def parts_of(values: Floats) -> list[slice]:
    """Return the parts of cycles with a period of their own, as after each step of the velocity.

    Or with a drop of their own. Each part differs from its neighbours by far more than its cycles
    do; a single part is none.
    """
    size = np.log(np.maximum(values, TINY))
    edges = [0, *_splits(size), len(size)]
    margins = [_margin(size, edges, k) for k in range(1, len(edges) - 1)]
    while margins and min(margins) < 0.0:
        k = int(np.argmin(margins))
        del edges[k + 1], margins[k]
        for beside in range(max(k - 1, 0), min(k + 1, len(margins))):
            margins[beside] = _margin(size, edges, beside + 1)
    return [slice(a, b) for a, b in pairwise(edges)]


def _splits(size: Floats) -> list[int]:
    """Return where a sequence is best split in two, and each part again (binary segmentation).

    A part whose values all lie within half a change is not split: no edge in it is a change.
    """
    found, waiting = [], [(0, len(size))]
    least = LEAST_GAIN * white_noise(size, order=1) ** 2  # single steps do not move it
    while waiting:
        first, last = waiting.pop()
        part, count = size[first:last], last - first
        places = np.arange(FEW_CYCLES, count - FEW_CYCLES + 1)
        if not len(places) or np.ptp(part) < 0.5 * CHANGED:
            continue
        total = np.cumsum(part - part.mean())[places - 1]
        gain = total**2 * (1.0 / places + 1.0 / (count - places))
        best = int(np.argmax(gain))
        if gain[best] > least:
            at = first + int(places[best])
            found.append(at)
            waiting += [(first, at), (at, last)]
    return sorted(found)


def _margin(size: Floats, edges: list[int], k: int) -> float:
    """Return by how much the parts about an edge differ beyond a change; negative if it is none."""
    before, after = size[edges[k - 1] : edges[k]], size[edges[k] : edges[k + 1]]
    change = abs(float(np.median(after) - np.median(before)))
    spread = max(float(np.ptp(np.percentile(part, (10.0, 90.0)))) for part in (before, after))
    return change - max(CHANGED, 2.0 * spread)


def built_up(drop: ArrayLike) -> slice:
    """Return the slice of swings without the build-up before and the decay after them.

    The number of these depends on sampling and noise: they are not cycles of the motion. Smaller
    swings that form a part of their own, as under a smaller load, are cycles.
    """
    size = np.asarray(drop, dtype=np.float64)
    first, last = (_building(each) for each in (size, size[::-1]))
    return slice(first, len(size) - last)


def _building(size: Floats) -> int:
    """Return how many swings build up at the beginning."""
    count = _below(size)
    if not count:
        return 0
    first = size[parts_of(size)[0]]
    grows = order(first) >= -ORDERED and np.ptp(np.log(np.maximum(first, TINY))) > GROWN
    return count if grows else _below(first)


def _below(size: Floats) -> int:
    """Return the number of small swings at the beginning; 0 if they are few."""
    if not len(size):
        return 0
    count = int(np.argmax(size >= BELOW * median(size)))
    return count if count >= BUILDING else 0


def sizes_in_turn(drop: Floats) -> tuple[float, float] | None:
    """Return the usual large and small drop, if large and small ones alternate (period two).

    >>> sizes_in_turn(np.tile([1.0, 0.5], 11))
    (1.0, 0.5)
    """
    for first in (1, 2):
        large = np.arange(first, len(drop) - 1, 2)
        around = np.maximum(drop[large - 1], drop[large + 1])
        if len(large) < FEWEST_LARGE or np.mean(drop[large] > around) < IN_TURN:
            continue
        sizes = float(np.median(drop[large])), float(np.median(drop[first - 1 :: 2]))
        return sizes if sizes[0] > LARGER * sizes[1] else None
    return None


def slip_in_each(cycles: CycleTable) -> float | None:
    """Return by how much the force falls once more in nearly each cycle, N; None if it does not."""
    once = cycles["hesitations"] == 1.0
    if np.count_nonzero(once) < max(FEWEST_LARGE, IN_EACH * len(cycles)):
        return None
    depth = cycles["hesitation_depth"][once]
    return float(np.median(depth)) if depth.std() < EVEN_SLIPS * depth.mean() else None


def steady_change(rate: Floats) -> tuple[float, float] | None:
    """Return the first and last rate of loading (N/s) of cycles, if it goes on rising or falling.

    Each rate is the median of a quarter of the cycles. A drive that is accelerated makes it do so.
    """
    if len(rate) < 2 * FEW_CYCLES or not abs(order(rate)) >= -ORDERED or rate.min() <= 0.0:
        return None
    part = len(rate) // 4
    first, last = float(np.median(rate[:part])), float(np.median(rate[-part:]))
    return (first, last) if abs(np.log(last / first)) > CHANGED else None


def cycles_apart(cycles: CycleTable) -> NDArray[np.bool_]:
    """Return which cycles are far longer or deeper than all others: a pause, a knock, a slip.

    None are where the period changes: then each part has its own.
    """
    period, drop = cycles["period"], cycles["drop"]
    if len(period) < FEWEST_CYCLES or len(parts_of(period)) > 1:
        return np.zeros(len(period), bool)
    return stand_apart(period) | stand_apart(drop)


def stand_apart(values: Floats) -> NDArray[np.bool_]:
    """Return which values are far above the median, and far beyond all others, if these are rare.

    Of few values the others span all that is known.
    """
    if len(values) < FEWEST_CYCLES:
        return np.zeros(len(values), bool)
    middle = float(np.median(values))
    far = values >= FAR * middle
    if not far.any() or np.count_nonzero(far) * RARE > len(values):
        return np.zeros(len(values), bool)
    others = values[~far]
    ends = np.percentile(others, (10.0, 90.0)) if len(others) >= MANY else others
    return np.asarray(far & (values - middle >= BEYOND * np.ptp(ends)))
