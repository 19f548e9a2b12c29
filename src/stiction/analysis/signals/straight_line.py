"""Straight lines through points by least squares, and what is uncertain of them."""

from __future__ import annotations

from math import hypot, isnan, nan, sqrt
from typing import Any, NamedTuple

import numpy as np

from stiction.analysis.signals.correlated_noise import error_of_few, whole_correlation_time
from stiction.arrays import Floats


class StraightLine(NamedTuple):
    """A straight line through points, by its level at their centre, and standard errors.

    So rounding leaves no error where points are far from 0, as times since 1970 are.
    """

    slope: float
    level: float
    centre: float
    slope_error: float = nan
    offset_error: float = nan

    @property
    def offset(self) -> float:
        """Height at 0."""
        return self.level - self.slope * self.centre

    def at(self, x: Any) -> Any:
        """Return the height at some places."""
        return self.level + self.slope * (x - self.centre)

    def deviations(self, x: Floats, y: Floats) -> Floats:
        """Return what points deviate by from the line."""
        return np.asarray(y - self.at(x))

    def correlated_error(self, x: Floats, y: Floats) -> float:
        """Return the standard error of the slope where neighbours deviate alike.

        As many points count as one as `whole_correlation_time` returns.
        """
        alike = whole_correlation_time(self.deviations(x, y))
        return error_of_few(self.slope_error * alike**0.5, len(x) / alike - 2.0)


def line(x: Floats, y: Floats) -> StraightLine:
    """Return the least-squares line; NaN where a number is unknown."""
    away = x - x.mean()
    spread = float((away**2).sum())
    found = StraightLine(nan, float(y.mean()), float(x.mean()))
    if len(x) < 2 or spread == 0.0:
        return found
    found = found._replace(slope=float((away * (y - y.mean())).sum()) / spread)
    if len(x) < 3:
        return found
    variance = float((found.deviations(x, y) ** 2).sum()) / (len(x) - 2)
    of_offset = variance * (1.0 / len(x) + x.mean() ** 2 / spread)
    return found._replace(slope_error=sqrt(variance / spread), offset_error=sqrt(of_offset))


def line_of_few(x: Floats, y: Floats, errors: Floats) -> StraightLine:
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
    by_scatter = (error_of_few(each, len(x) - 2.0) for each in found[3:])
    by_points = (float(np.linalg.norm(each * errors)) for each in weights)
    return StraightLine(*found[:3], *map(hypot, by_scatter, by_points))
