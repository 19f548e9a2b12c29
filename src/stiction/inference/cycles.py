"""Cycles of a sampled force, of a record and of simulated ones alike.

`stiction.analysis.find_cycles` tells them from all that may disturb a record, but takes a hundred
times as long. Thousands of simulations are not disturbed; a record must have cycles by both.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.analysis.motion.noiseless.zigzag import zigzag
from stiction.arrays import Floats, Indices

# of the usual fall: a larger one is a slip. The force rises by 0.16 of a fall after it behind a
# filter of eighth order, and irregular slips of a third of the usual one would be missed by 0.3
SLIP = 0.2
MOST_NOISE = 0.5  # of the span of the force once it is loaded: noise is taken for no more
TAILS = (2.0, 98.0)  # percentiles that bound the span, so that a spike does not
OF_NOISE = 8.0  # standard deviations of noise: white noise in a cycle does not reach so far
LEAST_CYCLES = 6  # in a record that is fitted


class Cycles(NamedTuple):
    """Cycles of a sampled force: indices of the trough before, the peak, and the trough after."""

    before: Indices
    peak: Indices
    after: Indices


def slip_cycles(force: Floats, noise: float = 0.0) -> Cycles:
    """Return the whole cycles of a force, from trough over peak to trough.

    The first begins at the end of a slip: a least force after no slip is where the record begins,
    as at an unloaded spring, whose loading is longer than that of any cycle.

    Parameters
    ----------
    force : ndarray
        (n,), of equally spaced samples.
    noise : float, optional
        Standard deviation of its noise.

    Examples
    --------
    >>> saw = np.tile(np.r_[0.0:1.0:10j, 0.6, 0.3], 4)
    >>> slip_cycles(saw).peak, slip_cycles(np.r_[0.1, saw]).peak
    (array([21, 33]), array([22, 34]))
    >>> slip_cycles(np.r_[-9.0:0.0:100j, saw]).peak
    array([121, 133])
    """
    height = least_slip(force[end_of_loading(force) :], noise)
    turns = zigzag(force, height)
    if len(turns) and np.ptp(force[: turns[0] + 1]) <= height:
        turns = turns[1:]
    if len(turns) > 1 and force[turns[0]] > force[turns[1]]:
        turns = turns[1:]
    count = max((len(turns) - 1) // 2, 0)
    whole = turns[: 2 * count + 1]
    return Cycles(whole[:-1:2], whole[1::2], whole[2::2])


def least_slip(force: Floats, noise: float) -> float:
    """Return the least height of a slip: above the noise, and a share of the usual fall.

    The span of the force does not tell it: that grows where the mean drifts, and where peaks
    and troughs scatter. A small fall may interrupt a large one, or the rise before it: falls are
    measured again between reversals that are slips.

    Parameters
    ----------
    force : ndarray
        (n,), once it is loaded.
    noise : float
        Standard deviation of its noise.

    Examples
    --------
    >>> saw = np.tile(np.r_[0.0:1.0:9j, 0.5], 4)
    >>> least_slip(saw, 0.0), round(least_slip(saw + 0.1 * np.arange(40.0), 0.0), 2)
    (0.2, 0.16)
    >>> least_slip(saw, 0.04), least_slip(saw, 0.3)
    (0.32, 0.5)
    """
    low, high = np.percentile(force, TAILS)
    height = min(OF_NOISE * noise, MOST_NOISE * float(high - low))
    while (more := SLIP * usual_fall(force[zigzag(force, height)])) > height:
        height = more
    return height


def usual_fall(turns: Floats) -> float:
    """Return the fall beyond which the falls make up half of the sum of all squares.

    However many small ones noise makes, they hardly count.

    >>> usual_fall(np.array([3.0, 2.9, 3.0, 2.0, 3.0, 1.9, 2.0, 1.9, 2.1, 0.8]))
    1.1
    """
    falls = np.sort(-np.diff(turns))
    falls = falls[falls > 0.0]
    squares = np.cumsum(falls * falls)
    return float(falls[np.searchsorted(squares, 0.5 * squares[-1])]) if len(falls) else 0.0


def end_of_loading(force: Floats) -> int:
    """Return the first sample that reaches the median of the samples after it.

    A force that goes to and fro from the beginning reaches it within the first cycle.

    >>> saw = np.tile(np.r_[0.0:1.0:5j, 0.5], 4)
    >>> end_of_loading(saw), end_of_loading(np.r_[-9.0:0.0:10j, saw])
    (2, 12)
    """
    force = force if force[0] <= np.median(force) else -force
    start = 0
    while onwards := int(np.argmax(force[start:] >= np.median(force[start:]))):
        start += onwards
    return start
