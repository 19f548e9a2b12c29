"""Whether a force has settled in the end of a stretch in which nothing is changed."""

from __future__ import annotations

from math import hypot, isnan, nan, sqrt
from typing import NamedTuple

import numpy as np

from stiction.analysis.signals.robust import error_of_few
from stiction.arrays import Floats

SETTLED = 0.2  # of a stretch: its end, in which friction counts as steady
# Of the drive's speed, at which the spring is still loaded: a mass that rests has 1, one that
# slides 0. One that breaks away in the end of the stretch, after a share f of it, has f^2 (3 - 2f):
# at 0.1 the mean force there is too small by 0.4 % of the loading in a whole stretch. A vibration
# of fewer than three cycles there may have as much, and its mean is as uncertain.
RESTS = 0.1
# Of the force's change within a stretch. Where it tends to its value exponentially, its mean in the
# end of the stretch is off by as much as it still changes there, within a factor of two.
CHANGES = 0.01
ROUNDED = 1e-5  # of the force: a change that an accurate solution may have
BLOCKS = 8  # means of the end of a stretch, that noise and vibrations are known by
CERTAIN = 5.96  # standard errors, Student's t with 6 degrees of freedom: by chance 1 in 1000


def has_settled(time: Floats, force: Floats, late: int) -> bool:
    """Return whether a force over a stretch has settled in its last samples, `late` in number.

    It has not if it still changes there, for sure and by more than a small share of all its change
    in the stretch. While a spring is loaded that is a fifth.
    """
    rise = line(*_blocks(time[-late:], force[-late:]))
    change = abs(rise.slope) * float(time[-1] - time[-late])
    least = max(CHANGES * float(np.ptp(force)), ROUNDED * float(np.abs(force).max()))
    return not (abs(rise.slope) > CERTAIN * rise.slope_error and change > least)


def _blocks(time: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return means of equally many neighbours, at most some few."""
    count = min(BLOCKS, len(time))
    parts = [np.array_split(each, count) for each in (time, values)]
    times, means = (np.array([float(part.mean()) for part in each]) for each in parts)
    return times, means


class StraightLine(NamedTuple):
    """A straight line through points, and the standard errors of its two numbers."""

    slope: float
    offset: float
    slope_error: float = nan
    offset_error: float = nan


def trend(x: Floats, y: Floats, errors: Floats) -> StraightLine:
    """Return the line through few points, with errors by their scatter and by their own.

    Scatter tells two numbers by few values, see `error_of_few`; with fewer than three points the
    errors are NaN.
    """
    found = line(x, y)
    if isnan(found.slope_error):
        return found
    away = x - x.mean()
    share = away / (away @ away)
    weights = share, 1.0 / len(x) - x.mean() * share
    by_scatter = (error_of_few(each, len(x) - 2.0) for each in found[2:])
    by_points = (float(np.linalg.norm(each * errors)) for each in weights)
    return StraightLine(*found[:2], *map(hypot, by_scatter, by_points))


def line(x: Floats, y: Floats) -> StraightLine:
    """Return the least-squares line; NaN where a number is unknown."""
    away = x - x.mean()
    spread = float((away**2).sum())
    if len(x) < 2 or spread == 0.0:
        return StraightLine(nan, nan)
    slope = float((away * (y - y.mean())).sum()) / spread
    offset = float(y.mean() - slope * x.mean())
    if len(x) < 3:
        return StraightLine(slope, offset)
    left = float(((y - offset - slope * x) ** 2).sum()) / (len(x) - 2)
    return StraightLine(
        slope, offset, sqrt(left / spread), sqrt(left * (1.0 / len(x) + x.mean() ** 2 / spread))
    )
