"""A quantity as a record shows it, and as it is stated."""

from __future__ import annotations

from math import inf, isfinite, nan
from typing import NamedTuple

from stiction.analysis.signals.correlated_noise import ERRORS_95, ERRORS_997, error_of_few
from stiction.analysis.signals.robust import trimmed_mean
from stiction.arrays import Floats

FEWEST_SAMPLES = 6  # the duration of a fall, or a slope, is not known by fewer
ALIKE_VALUES = 0.1  # relative: a mean that was measured agrees so far with its stated value
OF_MEDIAN = 1.22  # standard error of a median, over that of the mean without a tenth at each end


class StatedQuantity(NamedTuple):
    """A quantity as the record shows it, with its standard error, and as it is stated.

    NaN where it is not known. The error is that of the scatter, and for the duration of slips of
    what samples and noise hide. Creep slows the rise of the force, and friction that weakens, or a
    filter, a slip: what these show is only a lower bound (`is_bound`). `low` and `high` bound the
    ratio of both where they agree. Where the cycles change once, it is of some of them, a `part` of
    the record in words: those that start from `begin` on and before `end`, s.
    """

    quantity: str
    unit: str
    found: float
    error: float
    stated: float
    low: float
    high: float
    how: str
    part: str = ""
    begin: float = -inf
    end: float = inf
    is_bound: bool = False

    @property
    def name(self) -> str:
        """The quantity, and the part of the record."""
        return f"{self.quantity} {self.part}" if self.part else self.quantity

    @property
    def ratio(self) -> float:
        """Found over stated."""
        return self.found / self.stated if self.stated else nan

    @property
    def at_least(self) -> float:
        """The lower bound, two standard errors below the value found; NaN if it excludes nothing.

        What is bounded is positive: a bound that is not says no more than that.
        """
        bound = self.found - ERRORS_95 * self.error if self.is_bound else nan
        return bound if bound > 0.0 else nan

    @property
    def is_shown(self) -> bool:
        """Whether the record shows a value, or at least a bound that says something."""
        hidden = self.is_bound and self.found <= ERRORS_95 * self.error
        return isfinite(self.found) and not hidden

    @property
    def agrees(self) -> bool | None:
        """Whether both agree; None if one is not known."""
        return self.low <= self.ratio <= self.high if isfinite(self.ratio) else None

    @property
    def is_same(self) -> bool:
        """Whether the value found is the stated one, not only one that it allows."""
        apart = abs(self.found - self.stated)
        return bool(apart <= max(ALIKE_VALUES * abs(self.stated), ERRORS_997 * self.error))


def median_error(values: Floats) -> float:
    """Return the standard error of the median of some values."""
    return error_of_few(OF_MEDIAN * trimmed_mean(values).error, len(values) - 1.0)
