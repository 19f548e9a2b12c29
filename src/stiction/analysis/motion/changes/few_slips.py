"""The slips of a record that has too few of them for a gap between small and large reversals.

One fall tells nothing by its height. It is a slip by its shape: the spring is loaded evenly before
it, by itself or beside noise, far more slowly than it falls, and then again at the same rate.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.analysis.motion.rest import STICKING, rise_share
from stiction.analysis.signals.peak_refinement import Vertices, vertices
from stiction.analysis.signals.reversals import remove_reversals
from stiction.analysis.signals.robust import MEANS_OF_RECORD, block_means, part_means
from stiction.analysis.signals.straight_line import line
from stiction.analysis.signals.turning_points import CLEAR, TurningPoints, without_spikes
from stiction.arrays import TINY, Floats, Indices
from stiction.recording.noise import white_noise

FEW_SLIPS = 8  # slips; more stand apart by their heights
LEAST_FALL, FALLS = 0.05, 8.0  # of the range of the force, and standard deviations of noise: a fall
LOADED, RELOADED = 0.3, 0.15  # of a fall, at least: the rises before and after it
TOP = 0.2  # of a rise, near its peak: there the mass creeps
FEWEST_MEANS, PARTS_OF_LOADING = 8, 32  # in the rest of it, and in how many it is looked at
STRAIGHT = 0.05  # of a rise: its root mean square distance from a straight line
REACH = 2.0  # standard deviations of noise, which hide where a fall begins and ends
RISEN = 0.5  # of a rise, passes the line
ALIKE_RATES = 1.6  # ratio of two rates of loading
SLOW = float(1.0 / rise_share(STICKING) - 1.0)  # a fall over the time in which it is loaded again


class FewSlips(NamedTuple):
    """The turning points of a force with few slips, and where its first loading is even from."""

    points: TurningPoints  # a peak first, a trough last
    # (1,), as far below the first peak as it falls, or less: there a trough would be (s, N)
    begin: Vertices

    def corners(self, time: Floats) -> Vertices:
        """Return the begin, and then peaks and troughs in turn, of a force at some times (s)."""
        columns = zip(self.begin, vertices(time, self.points), strict=True)
        return Vertices(*(np.concatenate(each) for each in columns))


def few_slips(time: Floats, force: Floats) -> FewSlips | None:
    """Return the slips of a force that has a few of them; None if it is no such force.

    All falls that are as large as a twentieth of its range must be slips.
    """
    if len(force) < PARTS_OF_LOADING:
        return None
    noise = white_noise(force, order=2)
    height = LEAST_FALL * float(np.ptp(part_means(force, MEANS_OF_RECORD)))
    width = int(max((FALLS * noise / max(height, TINY)) ** 2, 1.0))
    if len(force) < PARTS_OF_LOADING * width:
        return None
    values, times = (block_means(each, width) for each in (without_spikes(force), time))
    points = _without_small_ends(values, remove_reversals(values, height)[0], height)
    falls = np.flatnonzero(np.diff(values[points]) < 0.0)
    if not 0 < len(falls) <= FEW_SLIPS or falls[0] == 0 or falls[-1] >= len(points) - 2:
        return None
    rates = [_rate_of_slip(times, values, points[k - 1 : k + 3]) for k in falls]
    if not all(rates):
        return None
    index = points[1:-1]
    bottom = np.array([max(values[points[0]], values[points[2]])])
    before = int(np.flatnonzero(values[: index[0]] <= bottom)[-1])
    both = slice(before, before + 2)  # the force may stay on a level before it falls
    begin = Vertices(np.interp(bottom, values[both], times[both]), bottom)
    low = np.arange(len(index)) % 2 == 1
    reach = REACH * noise / width**0.5
    return FewSlips(TurningPoints(index, low, values, width, reach, CLEAR, height), begin)


def _without_small_ends(values: Floats, points: Indices, height: float) -> Indices:
    """Return turning points without the first and last leg where these are less than a height."""
    legs = np.flatnonzero(np.abs(np.diff(values[points])) >= height)
    return points[legs[0] : legs[-1] + 2] if len(legs) else points[:0]


def _rate_of_slip(time: Floats, values: Floats, corners: Indices) -> float:
    """Return the rate at which a force is loaded before a slip; 0 if it is none.

    It is loaded again as fast after it. The corners are the begin of the first rise, its peak, the
    trough, and the end of the second rise.
    """
    begin, peak, trough, end = corners.tolist()
    drop = float(values[peak] - values[trough])
    before = _rate(time[begin : peak + 1], values[begin : peak + 1], drop, LOADED * drop)
    after = _rate(time[trough : end + 1], values[trough : end + 1], drop, RELOADED * drop)
    alike = before > 0.0 and 1.0 / ALIKE_RATES < after / before < ALIKE_RATES
    if not alike or float(time[trough] - time[peak]) > SLOW * drop / max(before, after):
        return 0.0
    return before


def _rate(time: Floats, rise: Floats, drop: float, least: float) -> float:
    """Return the rate of a rise to the end of some values, as far as it is even; 0 if it is not.

    Of a longer one only so much counts as the force drops by.
    """
    height = min(float(rise[-1] - rise[0]), drop)
    if height < least:
        return 0.0
    first = int(np.flatnonzero(rise <= max(rise[-1] - height, rise[0]))[-1])
    last = int(np.argmax(rise[first:] > rise[-1] - TOP * height)) + first
    if last - first < FEWEST_MEANS:
        return 0.0
    parts = np.stack([part_means(each[first:last], PARTS_OF_LOADING) for each in (time, rise)])
    way = line(*parts)
    even = float(np.std(way.deviations(*parts))) < STRAIGHT * height
    risen = way.slope * float(time[last] - time[first])  # else it is a step, or noise
    return way.slope if even and risen > RISEN * height else 0.0
