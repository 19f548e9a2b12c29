"""An even grid of times for samples with gaps, or with a clock that is not quite even.

Spectra need even times. A force is interpolated there by straight lines: they invent no swings, as
a smoother curve would between two samples that are close to each other and differ by noise. They
make a line of frequency f, sampled at a rate r, smaller by the factor (sin(pi f/r)/(pi f/r))^2 at
most.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.signals.straight_line import line
from stiction.arrays import Floats, compute_once
from stiction.recording.guess.clock import ONE_MISSING
from stiction.recording.part import begin_and_end
from stiction.text.quantity.wording import percent

ON_GRID = 0.1  # of a step: how far a sample may lie off the grid to count as on it
OWN = 0.4  # of a step: samples so close to their own times leave none out, which one lies 0.5 off
MOST_MISSING = 0.1  # of the grid's points, without a spectrum beyond
CROWDED = 0.5  # of a step: so close to the sample before, a sample is one too many
MOST_CROWDED = 0.25  # of the samples: a clock that jitters by a third of a step has 15 %
COARSER = 3  # mean intervals: a step in which 1 of 20 has no sample, if their times are random
FEWEST_SAMPLES = 16  # samples with which the step is first refined


@dataclass(frozen=True, eq=False)
class EvenGrid:
    """Evenly spaced times through a record's times."""

    places: Floats  # (n,) of the record's samples on the grid, in steps from its first time
    # the first time of the grid and its step, s
    start: float
    step: float
    size: int  # number of its times

    @property
    def exact(self) -> bool:
        """Whether the record's samples lie on the grid, one at each time."""
        return self.size == len(self.places) and not self.off_grid.any()

    @cached_property
    def _off(self) -> Floats:
        """How far each sample lies off the grid, in steps."""
        return np.asarray(self.places - np.rint(self.places))

    @cached_property
    def missing(self) -> NDArray[np.bool_]:
        """(size,) which of the grid's times lie in a gap."""
        found = np.zeros(self.size, bool)
        gaps = np.flatnonzero(np.diff(self.places) > ONE_MISSING)
        for before, after in zip(self.places[gaps], self.places[gaps + 1], strict=True):
            found[int(np.floor(before + 0.5)) + 1 : int(np.ceil(after - 0.5))] = True
        return found

    @property
    def gaps(self) -> int:
        """Number of gaps in which samples are missing."""
        return int(np.count_nonzero(np.diff(self.missing, prepend=False) & self.missing))

    @property
    def crowded(self) -> float:
        """The share of samples that follow the one before too closely."""
        return float(np.mean(np.diff(self.places) < CROWDED))

    @property
    def coarse(self) -> bool:
        """Whether there are several samples for each time, which stand at random."""
        return self.size < len(self.places) / (1.0 + MOST_MISSING)

    @property
    def off_grid(self) -> NDArray[np.bool_]:
        """(n,) which samples do not lie on the grid."""
        return np.asarray(np.abs(self._off) > ON_GRID)

    @property
    def has_gaps(self) -> bool:
        """Whether so much of the time lies in gaps that a spectrum cannot be computed."""
        return bool(self.missing.mean() > MOST_MISSING)

    @property
    def serves(self) -> bool:
        """Whether a spectrum can be computed on the grid."""
        even = self.coarse or self.crowded <= MOST_CROWDED
        return even and not self.has_gaps

    def on(self, values: Floats) -> Floats:
        """Return values at the grid's times, from values at the record's own times."""
        if self.exact:
            return values
        at = np.arange(self.size, dtype=np.float64)
        found = np.interp(at, self.places, values)
        near = np.flatnonzero(np.abs(self._off) <= ON_GRID)
        place = np.rint(self.places[near]).astype(np.intp)
        inside = (place >= 0) & (place < self.size)
        found[place[inside]] = values[near[inside]]
        return np.asarray(found)

    def close_gaps(self, time: Floats) -> Floats:
        """Return the record's own times (n,) as if each gap lasted for one step, s."""
        steps = np.diff(time)
        steps[np.diff(self.places) > ONE_MISSING] = self.step
        return np.concatenate([time[:1], time[0] + np.cumsum(steps)])

    def between(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return slowly changing values at the record's own times, from values on the grid."""
        return np.asarray(np.interp(self.places, np.arange(self.size), values))


@compute_once
def even_grid(time: Floats) -> EvenGrid | None:
    """Return the even grid that is closest to increasing times (s), None for fewer than two."""
    n = len(time)
    if n < 2:
        return None
    plain = _grid(time, float(time[0]), float(time[-1] - time[0]) / (n - 1), n)
    if plain.exact:
        return plain
    number = np.arange(n, dtype=np.float64)
    fitted = line(number, time)
    each = _grid(time, fitted.offset, fitted.slope, n)
    if np.abs(each.places - number).max() < OWN:  # a clock that jitters, or times that are rounded
        return each
    start, step = _fit_grid(time)
    start -= step * np.floor((start - time[0]) / step + 0.5)
    size = int(np.floor((time[-1] - start) / step + 0.5)) + 1
    if size > n / (1.0 - MOST_MISSING) + 2:  # so many are missing that it is of no use
        size = min(size, 4 * n)
    found = _grid(time, float(start), step, size)
    if found.serves or n < COARSER * FEWEST_SAMPLES:
        return found
    size = (n - 1) // COARSER + 1
    coarse = _grid(time, float(time[0]), plain.step * (n - 1) / (size - 1), size)
    return coarse if coarse.serves else found


def _grid(time: Floats, start: float, step: float, size: int) -> EvenGrid:
    """Return a grid with the places of times on it, but not these: it lives as long as they do."""
    return EvenGrid(np.asarray((time - start) / step), start, step, size)


def _fit_grid(time: Floats) -> tuple[float, float]:
    """Return start and step of the grid, fitted to ever more samples, outliers left out."""
    middle = len(time) // 2  # the first interval, and the last, may be unlike the others
    step, start = float(np.median(np.diff(time))), float(time[middle])
    around = FEWEST_SAMPLES
    while True:
        part = time[max(middle - around, 0) : middle + around]
        for _ in range(2):
            place = (part - start) / step
            near = np.abs(place - np.rint(place)) < 0.5 - ON_GRID
            if np.count_nonzero(near) < 2:
                return start, step
            number = np.rint(place[near])
            if number[0] == number[-1]:
                return start, step
            fitted = line(number, part[near])
            start, step = fitted.offset, fitted.slope
        if around >= len(time):
            return start, step
        around *= 2


def why_not(grid: EvenGrid | None) -> str:
    """Return why a spectrum cannot be computed, in words; '' if it can."""
    if grid is None:
        return "a spectrum needs at least two samples"
    if grid.serves:
        return ""
    remedy = f"analyse a part without gaps ({begin_and_end()}), or sample it evenly"
    if grid.has_gaps:
        return (
            f"{percent(grid.missing.mean())} of the time lies in gaps between samples, and a "
            f"spectrum allows {percent(MOST_MISSING)}: {remedy}"
        )
    return (
        f"{percent(grid.crowded)} of the samples follow the one before within half the typical "
        f"interval, and a spectrum allows {percent(MOST_CROWDED)}: {remedy}"
    )
