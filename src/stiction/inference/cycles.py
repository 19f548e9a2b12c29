"""Cycles of a sampled force, of a record and of simulated ones alike.

`stiction.analysis.find_cycles` tells them from all that may disturb a record, but takes a hundred
times as long. Thousands of simulations are not disturbed; a record must have cycles by both.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.arrays import Floats, Indices
from stiction.study.variables.zigzag import zigzag

# of the span of the force once it is loaded: a larger fall is a slip, without noise and with much
DROP = 0.3, 0.5
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
    as at an unloaded spring, whose loading is longer than that of any cycle. How high a fall must
    be to be a slip does not depend on this loading either. Samples are equally spaced; `noise` is
    the standard deviation of theirs.

    Examples
    --------
    >>> saw = np.tile(np.r_[0.0:1.0:10j, 0.6, 0.3], 4)
    >>> slip_cycles(saw).peak, slip_cycles(np.r_[0.1, saw]).peak
    (array([21, 33]), array([22, 34]))
    >>> slip_cycles(np.r_[-9.0:0.0:100j, saw]).peak
    array([121, 133])
    """
    low, high = np.percentile(force[end_of_loading(force) :], TAILS)
    least, most = np.multiply(DROP, high - low)
    height = min(max(least, OF_NOISE * noise), most)
    turns = zigzag(force, height)
    if len(turns) and np.ptp(force[: turns[0] + 1]) <= height:
        turns = turns[1:]
    if len(turns) > 1 and force[turns[0]] > force[turns[1]]:
        turns = turns[1:]
    count = max((len(turns) - 1) // 2, 0)
    whole = turns[: 2 * count + 1]
    return Cycles(whole[:-1:2], whole[1::2], whole[2::2])


def end_of_loading(force: Floats) -> int:
    """Return the first sample that is as large as half of those after it; or as small.

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
