"""Theoretical boundaries in the plane of two dimensions of a study."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import product
from math import log, nan, radians, sin
from typing import NamedTuple

import numpy as np

from stiction import linear_stability as stability
from stiction import theory
from stiction.arrays import Floats
from stiction.drive import ConstantVelocity
from stiction.errors import StictionError
from stiction.study.plan.coordinates import ascending, values_at, vary
from stiction.study.plan.study import Study
from stiction.system.parameter import change_unchecked
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
    steps = tuple(steps_between(study, dim) for dim in (x, y))
    sliders = _sliders(study, (x, y), sides, values_at(study.coordinates, at))
    theories = {PHI_C: stability.growth_rate, ZETA: log_damping_ratio}
    fields = {name: _field(of, sliders, size, steps) for name, of in theories.items()}
    first, second = (own.get(dim, next(iter(own.values()))) for dim, own in sides.items())
    return Plane(first, second, fields)


Index = tuple[int, ...]
Sliders = Callable[[Index], Slider]


def _field(of: Callable[[Slider], float], sliders: Sliders, size: Index, steps: Index) -> Floats:
    """Return a field of which only the zeros are wanted: it is fine beside these alone.

    Elsewhere its values are those at the runs next to them, which have the same sign.
    """

    def value(place: Index) -> float:
        try:
            return of(sliders(place))
        except StictionError:
            return nan

    coarse = tuple(np.arange(0, count, step) for count, step in zip(size, steps, strict=True))
    known = np.array([[value((i, j)) for j in coarse[1].tolist()] for i in coarse[0].tolist()])
    signs = np.sign(known)
    nearest = (
        np.minimum(np.arange(n) // k, len(its) - 1)
        for n, k, its in zip(size, steps, coarse, strict=True)
    )
    found = known[np.ix_(*nearest)]
    for i, j in np.ndindex(*(max(len(each) - 1, 1) for each in coarse)):
        corners = signs[max(i - 1, 0) : i + 3, max(j - 1, 0) : j + 3]
        if (corners == corners.flat[0]).all():
            continue
        for place in np.ndindex(steps[0] + 1, steps[1] + 1):
            here = i * steps[0] + place[0], j * steps[1] + place[1]
            if here[0] < size[0] and here[1] < size[1]:
                found[here] = value(here)
    return found


def _sliders(
    study: Study,
    dims: tuple[str, ...],
    sides: Mapping[str, Mapping[str, Floats]],
    held: Mapping[str, tuple[float, str]],
) -> Sliders:
    """Return a function from a place in a plane to its slider.

    Descriptions are validated at the corners; values between them need no check.
    """

    def changes(place: Index) -> dict[str, tuple[float, str]]:
        return dict(held) | {
            path: (float(values[i]), study.coordinates[path].unit)
            for dim, i in zip(dims, place, strict=True)
            for path, values in sides[dim].items()
        }

    def checked(place: Index) -> Slider:
        return vary(study.base, changes(place)).slider

    ends = [(0, len(next(iter(sides[dim].values()))) - 1) for dim in dims]
    try:
        corners = [checked(place) for place in product(*ends)]
    except StictionError:
        return checked

    def between(place: Index) -> Slider:
        slider = corners[0]
        for path, (value, its) in changes(place).items():
            if path.split(".")[0] not in ("run", "initial"):
                slider = change_unchecked(slider, path, radians(value) if its == "deg" else value)
        return slider

    return between


def critical_values(study: Study, dim: str, at: Mapping[str, int]) -> Floats:
    """Return the values along a dimension, in the store's unit, where stability changes.

    None where a theory does not apply, or where several parameters vary along it.
    """
    its = along(study, dim)
    values = its.get(dim, next(iter(its.values())))
    sliders = _sliders(study, (dim,), {dim: its}, values_at(study.coordinates, at))

    def growth(place: int) -> float:
        try:
            return stability.growth_rate(sliders((place,)))
        except StictionError:
            return nan

    found = np.array([growth(i) for i in range(len(values))])
    before, after = found[:-1], found[1:]
    here = np.flatnonzero(before * after < 0.0)
    share = before[here] / (before[here] - after[here])
    return np.asarray(values[here] + share * (values[here + 1] - values[here]))


def steps_between(study: Study, dim: str) -> int:
    """Return the number of fine steps between two values of a dimension."""
    count = study.layout.shape[study.layout.dims.index(dim)]
    return -(-FINE_POINTS // max(count - 1, 1)) if count > 1 else 1


def along(study: Study, dim: str) -> dict[str, Floats]:
    """Return the values of each axis along a dimension, in order, with interpolated ones."""
    known = study.coordinates
    order = ascending(known, dim)
    axes = {path: each.values[order] for path, each in known.items() if each.dim == dim}
    count = len(next(iter(axes.values())))
    parts = steps_between(study, dim)
    places = np.linspace(0.0, count - 1, (count - 1) * parts + 1)
    return {path: interpolate(values, places) for path, values in axes.items()}


def interpolate(values: Floats, places: Floats) -> Floats:
    """Interpolate values, logarithmically if all are positive."""
    known = np.arange(len(values))
    if (values > 0.0).all():
        return np.asarray(np.exp(np.interp(places, known, np.log(values))))
    return np.asarray(np.interp(places, known, values))


def log_damping_ratio(slider: Slider) -> float:
    """Return the logarithm of `damping_ratio`."""
    ratio = damping_ratio(slider)
    return log(ratio) if ratio > 0.0 else nan


def damping_ratio(slider: Slider) -> float:
    """Return zeta of Eq. (10) at theta = phi; NaN without a steady drive or a misalignment."""
    motion, phi = slider.motion, abs(slider.misalignment)
    if not isinstance(motion, ConstantVelocity) or motion.velocity == 0.0 or sin(phi) == 0.0:
        return nan
    return float(theory.damping_ratio(theory.damping_number_of(slider, motion.velocity), phi))
