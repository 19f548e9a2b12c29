"""Quick falls of a force: the slips of a mass whose cycles noise hides.

Stick-slip loads a spring slowly and unloads it quickly; noise rises as quickly as it falls. So
where nearly all of the largest quick changes are falls, the mass slips, of whatever size and period
its slips are. Signs are counted, as in the sign test of statistics, so that noise of any colour and
distribution is alike.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.signals.digitised import fall_by_rounding
from stiction.analysis.signals.even_grid import even_grid
from stiction.analysis.signals.robust import largest_magnitude, uniform_mean
from stiction.analysis.signals.turning_points import surprise, without_spikes
from stiction.arrays import TINY, Floats, Indices

FEWEST_PARTS = 32  # of a force, of the length over which its changes are looked at
LARGER = 1.25  # times a rise: the samples of a vibration can be off its crests by so much
NEARLY_ALL = 0.9  # of the largest changes are falls
NEAR = 16  # lengths over which the mean change is taken off: what a slow wave adds to each
AS_GOOD = 0.9  # of the clearest: of two lengths as good, more of a fall ends within the longer one
# The clearness at which slips are as likely as noise. Of 10 000 records of noise (white, filtered,
# of heavy tails), vibration, settling and loading, 4 have more than 4, the most 4.9.
EVEN_CHANCE = 4.5
TINIEST = 1e-9  # of the force: smaller falls are those of numbers
# The steps of a converter, in which a drift falls one at a time, are clear if there are seven, and
# then the standard deviation of the force is two: falls above one deviation are not of a drift
DRIFTS = 1.0


class QuickFalls(NamedTuple):
    """Quick falls that no rise matches."""

    number: int  # how many there are
    height: float  # their median, N
    # the same over the standard deviation of the force, averaged over the time of a fall: 3.5 for a
    # sawtooth; less where the force wanders by itself
    times: float
    # minus the logarithm of (a bound of) the probability that so many of the largest changes are
    # falls, were rises as frequent
    clearness: float


NONE = QuickFalls(0, 0.0, 0.0, 0.0)


def quick_falls(time: Floats, force: Floats) -> QuickFalls:
    """Return the quick falls of a force that are least likely in noise.

    Its changes are looked at over 1, 2, 4, ... even steps of time, so that its change in a gap is
    not quick. A force whose times have no even grid has none.
    """
    grid = even_grid(time)
    if grid is None or not grid.serves:
        return NONE
    even = grid.on(force)
    sums = np.append(0.0, np.cumsum(without_spikes(even) - even.mean()))
    lengths = [2**power for power in range((len(even) // FEWEST_PARTS).bit_length())]
    least, steps = TINIEST * largest_magnitude(force), fall_by_rounding(force)
    seen = [
        each
        for length in lengths
        if (each := _clearest(sums, length)).height > max(least, steps * (each.times < DRIFTS))
    ]
    clearest = max((each.clearness for each in seen), default=0.0)
    return next((each for each in seen[::-1] if each.clearness >= AS_GOOD * clearest), NONE)


def changes(sums: Floats, length: int) -> Floats:
    """Return by how much each mean over a length exceeds the one before, from sums (n + 1,).

    What a slow wave adds is taken off, the mean nearby; and what loading adds, the mean of the
    middle third: a median jumps where a vibration has few phases, as hum of 20 samples a period.
    """
    jumps = (sums[2 * length :] - 2.0 * sums[length:-length] + sums[: -2 * length]) / length
    near = jumps - uniform_mean(jumps, NEAR * length)
    low, high = np.quantile(near, (1 / 3, 2 / 3))
    return np.asarray(near - near[(near >= low) & (near <= high)].mean())


def _clearest(sums: Floats, length: int) -> QuickFalls:
    """Return the clearest quick falls among the changes of a force over a length."""
    size, falls = extremes(changes(sums, length))
    order = np.argsort(-np.where(falls, size, LARGER * size), kind="stable")
    found, among = np.cumsum(falls[order]), np.arange(1, len(order) + 1)
    worth = np.where(found >= NEARLY_ALL * among, surprise(found, among, 0.5), 0.0)
    if not worth.any():
        return NONE
    best = int(np.argmax(worth))
    its = order[: best + 1]
    height = float(np.median(size[its[falls[its]]]))
    wander = float(np.std(sums[length:] - sums[:-length])) / length
    return QuickFalls(int(found[best]), height, height / max(wander, TINY), float(worth[best]))


def extremes(jumps: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """Return the size of the largest change between two changes of sign, and whether it falls."""
    falls = jumps < 0.0
    first: Indices = np.append(0, np.flatnonzero(np.diff(falls)) + 1)
    return np.maximum.reduceat(np.abs(jumps), first), falls[first]
