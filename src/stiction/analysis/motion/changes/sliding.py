"""The part of a record in which a mass slides: from its loading until the drive turns, or unloads.

Whatever begins and ends it, its forces lie about one level, and those of loading, turning and
unloading lie below, for good. A slip or a knock within it is below for a while, and belongs to it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.analysis.record import Record
from stiction.analysis.signals.robust import MEANS_OF_RECORD, part_means, part_starts
from stiction.analysis.signals.turning_points import without_spikes
from stiction.arrays import Floats
from stiction.recording.noise import seeming_motion

NO_LOAD = 0.05  # of the largest mean or level: a force that stays below is that of no load
# The level is that of the shortest interval with so many of the loaded means; with all of them at
# one level, in normal noise, it is as wide as 0.51 standard deviations, with fewer wider
SHARE, WIDTH = 1 / 5, 0.51
WITHIN = 6.0  # standard deviations below the level: no mean of some hundred is so low by chance
PASSED = 0.5  # of the level: a force that stays below does not slide, however it scatters
BRIEF = 2  # means: in so few a record may end while the drive turns
GUARD = 0.5  # of the sliding, at most, is left out before a fall
# Of the reach of the drive: so near its end it turns, or dwells. Of a sine it is 2 % of the stroke
TURNS = 1e-3


class Sliding(NamedTuple):
    """The part of a record in which the mass slides."""

    # its first sample, and the one after its last
    first: int
    last: int
    falls: int  # the sample from which on the force lies below for good; the number of all if none

    @property
    def half(self) -> int:
        """The sample in its middle; from there on it has settled."""
        return (self.first + self.last) // 2


def sliding(record: Record) -> Sliding:
    """Return the part of a record without cycles in which the mass slides: all of it, or less.

    The force under one load counts, and the displacement of the drive where it was measured.
    """
    begin, end = _moving(record)
    force = without_spikes(record.force) / record.relative_load()
    means = part_means(np.where(np.isfinite(force), force, 0.0), MEANS_OF_RECORD)
    starts = np.append(part_starts(len(force), MEANS_OF_RECORD), len(force))
    first, last, falls = (int(starts[at]) for at in _about_level(means))
    if max(first, begin) >= min(last, end):
        return Sliding(begin, end, end)
    return Sliding(max(first, begin), min(last, end), min(falls, end))


def _moving(record: Record) -> tuple[int, int]:
    """Return the range of samples in which the drive surely moves, without the ends of its path."""
    at = record.drive_position
    if at is None or not np.ptp(at) > seeming_motion(at):
        return 0, len(record)
    from_end = np.minimum(at - at.min(), at.max() - at)
    moves = np.flatnonzero(from_end > TURNS * np.ptp(at))
    if not len(moves):  # all but a wild sample, or a few, are at one end
        return 0, len(record)
    return int(moves[0]), int(moves[-1]) + 1


def _about_level(means: Floats) -> tuple[int, int, int]:
    """Return the first of some means at their level, the one after the last, and where they fall.

    The last mean is before the fall by as long as the force takes from the level to half of it:
    thus what is less than the noise below the level, where a fall begins slowly, is left out.
    """
    means = means if means.sum() >= 0.0 else -means
    level, deviation = _level(means)
    half = PASSED * level
    at = np.flatnonzero(means >= max(level - WITHIN * deviation, half))
    if not level > 0.0 or not len(at):
        return 0, len(means), len(means)
    first, falls = int(at[0]), int(at[-1]) + 1
    if not _is_passage(means[:first], half):
        first = 0
    if falls == len(means) or not _is_passage(means[falls:], half):
        falls = len(means)
        return first, falls, falls
    guard = int(np.flatnonzero(means > half)[-1]) + 2 - falls
    return first, falls - min(guard, int(GUARD * (falls - first))), falls


def _is_passage(means: Floats, half: float) -> bool:
    """Return whether means below a level pass half of it, or end with the record before.

    Others are those of friction that wanders.
    """
    return len(means) <= BRIEF or bool(means.min() < half)


def _level(means: Floats) -> tuple[float, float]:
    """Return the level about which most of the loaded means lie, and their standard deviation."""
    loaded = np.sort(means[means > NO_LOAD * means.max()])
    if len(loaded) < 2:
        return 0.0, 0.0
    count = max(int(SHARE * len(loaded)), 2)
    widths = loaded[count - 1 :] - loaded[: len(loaded) - count + 1]
    at = int(np.argmin(widths))
    return float(np.median(loaded[at : at + count])), float(widths[at]) / WIDTH
