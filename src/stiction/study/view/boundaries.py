"""Theoretical boundaries in the plane of two dimensions of a study."""

from __future__ import annotations

from collections.abc import Mapping
from math import nan, sin
from typing import NamedTuple

import numpy as np

from stiction import linear_stability as stability
from stiction import theory
from stiction.arrays import Floats
from stiction.drive import ConstantVelocity
from stiction.errors import StictionError
from stiction.study.plan.coordinates import ascending, values_at, vary
from stiction.study.plan.study import Study
from stiction.system.slider import Slider

FINE_POINTS = 60  # points in each direction, or as many as there are runs

PHI_C = r"steady sliding loses stability ($\varphi_c$)"
ZETA = r"$\zeta(\theta = \varphi) = 1$"


class Plane(NamedTuple):
    """Fields over a plane: coordinates of both sides, in the store's units, and fields (n, m)."""

    x: Floats
    y: Floats
    fields: Mapping[str, Floats]


def plane(study: Study, x: str, y: str, at: Mapping[str, int]) -> Plane:
    """Return the growth rate of steady sliding, and the logarithm of the damping ratio.

    Each is zero on its boundary: the linear stability of steady sliding, for any law; and
    zeta = A sin^3(phi) = 1, at the force angle at which slip begins (Nakano & Popov, Eq. (10)).
    NaN where a theory does not apply, for example to a drive program.

    Parameters
    ----------
    study : Study
        The study.
    x, y : str
        Dimensions.
    at : mapping of str to int
        The index along each other dimension.
    """
    sides = {dim: along(study, dim) for dim in (x, y)}
    size = tuple(len(next(iter(sides[dim].values()))) for dim in (x, y))
    fields = {PHI_C: np.full(size, nan), ZETA: np.full(size, nan)}
    held = values_at(study.coordinates, at)
    for place in np.ndindex(size):
        changes = dict(held)
        for dim, i in zip((x, y), place, strict=True):
            changes |= {
                path: (float(values[i]), study.coordinates[path].unit)
                for path, values in sides[dim].items()
            }
        try:
            slider = vary(study.base, changes).slider
            fields[PHI_C][place] = stability.growth_rate(slider)
            fields[ZETA][place] = np.log(damping_ratio(slider))
        except StictionError:
            continue
    first, second = (own.get(dim, next(iter(own.values()))) for dim, own in sides.items())
    return Plane(first, second, fields)


def along(study: Study, dim: str) -> dict[str, Floats]:
    """Return the values of each axis along a dimension, in order, with interpolated ones."""
    known = study.coordinates
    order = ascending(known, dim)
    axes = {path: each.values[order] for path, each in known.items() if each.dim == dim}
    count = len(next(iter(axes.values())))
    parts = -(-FINE_POINTS // max(count - 1, 1)) if count > 1 else 1
    places = np.linspace(0.0, count - 1, (count - 1) * parts + 1)
    return {path: interpolate(values, places) for path, values in axes.items()}


def interpolate(values: Floats, places: Floats) -> Floats:
    """Interpolate values, logarithmically if all are positive."""
    known = np.arange(len(values))
    if (values > 0.0).all():
        return np.asarray(np.exp(np.interp(places, known, np.log(values))))
    return np.asarray(np.interp(places, known, values))


def damping_ratio(slider: Slider) -> float:
    """Return zeta of Eq. (10) at theta = phi; NaN without a steady drive or a misalignment."""
    motion, phi = slider.motion, abs(slider.misalignment)
    if not isinstance(motion, ConstantVelocity) or motion.velocity == 0.0 or sin(phi) == 0.0:
        return nan
    return float(theory.damping_ratio(theory.damping_number_of(slider, motion.velocity), phi))
