"""Straight lines through points by least squares, and their uncertainty."""

from __future__ import annotations

from math import hypot, isnan, nan, sqrt
from typing import Any, NamedTuple

import numpy as np

from stiction.analysis.signals.correlated_noise import error_of_few
from stiction.arrays import TINY, Floats

# Correlation of neighbours: of noise that lasts for 1 to 100 values, each factor as likely
LASTING = 1.0 - np.geomspace(1.0, 0.01, 15)


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
        """Return the deviations of points from the line."""
        return np.asarray(y - self.at(x))


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


def slope_in_lasting_noise(x: Floats, y: Floats) -> tuple[float, float]:
    """Return the slope of a line, and its standard error, where neighbours may deviate alike.

    How alike they are, few of them hardly tell, and a line follows a part of what lasts. So slope
    and variance are means over many correlations, each as likely as it makes the deviations (by the
    restricted likelihood, H. D. Patterson & R. Thompson, Biometrika 58, 545 (1971)). With each the
    line is that of values made independent (S. J. Prais & C. B. Winsten, Cowles Commission
    Discussion Paper 383 (1954)). There are at least 3 points, nearly evenly spaced.
    """
    spread = float(x.std())
    each = LASTING[:, None]

    def independent(values: Floats) -> Floats:
        first = np.sqrt(1.0 - each**2) * values[0]
        return np.concatenate([first, values[1:] - each * values[:-1]], axis=1)

    level, way, value = map(independent, (np.ones(len(x)), (x - x.mean()) / spread, y - y.mean()))
    design = np.stack([level, way], axis=1)
    normal = design @ design.transpose(0, 2, 1)
    found = np.linalg.solve(normal, design @ value[:, :, None])
    left = np.maximum(((value[:, None] - found.transpose(0, 2, 1) @ design) ** 2).sum((1, 2)), TINY)
    freedom, slopes = len(x) - 2.0, found[:, 1, 0]
    likely = np.log(1.0 - LASTING**2) - np.linalg.slogdet(normal)[1] - freedom * np.log(left)
    weight = np.exp(0.5 * (likely - likely.max()))
    weight /= weight.sum()
    slope = float(weight @ slopes)
    variances = left / freedom * np.linalg.inv(normal)[:, 1, 1] + (slopes - slope) ** 2
    error = error_of_few(sqrt(float(weight @ variances)), freedom)
    return slope / spread, error / spread
