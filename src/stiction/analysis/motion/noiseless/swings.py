"""The swings of a run's force, and those that are cycles."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from stiction.analysis.motion.changes.cycles import built_up
from stiction.analysis.motion.course import dies_out, is_over
from stiction.analysis.motion.hesitations import Hesitations, cycle_corners
from stiction.arrays import Floats

if TYPE_CHECKING:  # else numba would be loaded for a measured record, too
    from stiction.analysis.motion.noiseless.features import Features


class SwingShapes(NamedTuple):
    """Complete swings of the force, from trough over peak to trough, (n,) each.

    Parameters
    ----------
    start : ndarray
        Time of the trough before each swing, s.
    period : ndarray
        From trough to trough, s.
    drop : ndarray
        From peak to trough, N.
    rise_share : ndarray
        Fraction of the period in which the force rises.
    """

    start: Floats
    period: Floats
    drop: Floats
    rise_share: Floats

    @property
    def end(self) -> float:
        """Time of the last trough, s; 0 without swings."""
        return float(self.start[-1] + self.period[-1]) if len(self.start) else 0.0

    @property
    def peak_time(self) -> Floats:
        """Time of the peak of each swing, s."""
        return self.start + self.rise_share * self.period

    def are_over(self, until: float) -> bool:
        """Return whether no swing follows for long until a time (s)."""
        return is_over(self.period, until - self.end)

    def die_out(self, until: float) -> bool:
        """Return whether the swings die out until a time (s): a transient, not cycles."""
        return dies_out(self.drop, self.period, until - self.end)

    def cycles(self, until: float) -> SwingShapes:
        """Return the swings that are cycles by the rules of `stiction.analysis.find_cycles`."""
        none = self.are_over(until) or self.die_out(until)
        return self.some(slice(0, 0) if none else built_up(self.drop))

    def some(self, which: slice) -> SwingShapes:
        """Return a part of the swings."""
        return SwingShapes(*(each[which] for each in self))


def corners(found: Features) -> Hesitations:
    """Return which turning points are the corners of complete swings, and the hesitations."""
    ends = found.first, found.last
    return cycle_corners(found.turn_value, found.turn_time, ends, found.trough)


def swings(found: Features) -> SwingShapes:
    """Return the complete swings between turning points, without hesitations."""
    kept = corners(found).kept
    time, value = found.turn_time[kept], found.turn_value[kept]
    start, peak, trough = time[:-1:2], time[1::2], time[2::2]
    period = trough - start
    return SwingShapes(start, period, value[1::2] - value[2::2], (peak - start) / period)
