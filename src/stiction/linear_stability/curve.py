"""The boundary of stability as a curve in two parameters, through folds and corners.

The next point is the change of sign on a circle about the present point (a spherical constraint:
Yamamura, IEEE Trans. Circuits Syst. I 40 (1993), 448). The plane is the unit square.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cache
from itertools import pairwise
from math import atan2, cos, hypot, pi, sin
from pathlib import Path
from typing import Any

import numpy as np

from stiction.arrays import Floats, xr
from stiction.errors import DescriptionError
from stiction.linear_stability.axis import Axis, axis, present_value, steadily_driven
from stiction.linear_stability.linear import growth_rate
from stiction.linear_stability.roots import leading_frequency, sign_changes, signed_growth
from stiction.system.description import Description
from stiction.system.slider import Slider, slider_of
from stiction.text.units import Quantity

LINES = (0.0, 0.25, 0.5, 0.75, 1.0)  # across both ranges, searched for points of curves
LOOKS = 33  # points on each line
Point = tuple[float, float]
Growth = Callable[[Point], float]  # beyond an edge of the plane, its value at the edge

LONGEST_STEP, SHORTEST_STEP = 0.02, 1e-4  # steps along the curve
STRAIGHT = 0.3  # rad; where the curve turns more in a step, the step is shortened
AHEAD = (0.4, 1.0, 1.6, 2.2)  # rad to both sides of straight ahead, searched in this order
CLOSE = 1e-9  # rad: a point is sought to that, so it is accurate to 2e-11 of the ranges
MOST_STEPS = 4000  # steps along one curve


def boundary(
    slider: Slider | Description | str | Path,
    x: str,
    y: str,
    *,
    x_between: Sequence[Quantity] | None = None,
    y_between: Sequence[Quantity] | None = None,
) -> xr.Dataset:
    """Follow the boundary of stable steady sliding through the plane of two parameters.

    Zeros of the growth rate are found on a few lines across the plane, including those through the
    slider's own parameters. From each zero, the curve is traced in both directions: the next point
    is the change of sign, nearest to straight ahead, on a small circle about the present point. A
    circle meets every curve, so that folds and corners (where another mode takes over) need no
    special treatment. A curve ends at the edge of the plane, or where it closes.

    Parameters
    ----------
    slider : Slider, Description, str or Path
        The system, or the file of its description.
    x, y : str
        The two parameters, see `critical`.
    x_between, y_between : tuple of float or str, optional
        Their ranges, see `critical`; the scale is logarithmic where the ends differ by more than
        a factor of ten.

    Returns
    -------
    Dataset
        Over ``point``: the parameters by their paths (SI), ``frequency`` of the critical mode
        (Hz), and the number ``branch`` of the connected curve. Along each curve, steady sliding
        is unstable on the left, with x to the right and y upwards. The points are accurate to
        1e-9 of the ranges or better. Attributes: ``x``, ``y``, their ranges
        ``x_range``, ``y_range``, ``x_scale``, ``y_scale`` ("log" or "linear"), and the slider's
        own ``x_own``, ``y_own`` (SI) and ``growth_rate`` (1/s).

    Raises
    ------
    DescriptionError
        If there are no such parameters or ranges, or no steady sliding.

    References
    ----------
    Continuation with a spherical constraint: Yamamura, IEEE Trans. Circuits Syst. I 40 (1993), 448.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> sorted(st.linear_stability.boundary(slider, "phi", "drive.velocity").data_vars)
    ['branch', 'drive.velocity', 'frequency', 'phi']
    """
    slider = steadily_driven(slider_of(slider), x, y)
    across, up = axis(slider, x, x_between), axis(slider, y, y_between)
    if across.path == up.path:
        raise DescriptionError.of(x, "spans no plane with itself; name two parameters")

    def at(point: Point) -> Slider:
        inside = (min(max(each, 0.0), 1.0) for each in point)
        return up.on(across.on(slider, next(inside)), next(inside))

    @cache
    def growth(point: Point) -> float:
        return growth_rate(at(point))

    branches: list[Floats] = []
    places = (each.fraction(present_value(slider, each.path)) for each in (across, up))
    for seed in seeds(lambda point: signed_growth(at(point)), *places):
        if not any(near(seed, branch) for branch in branches):
            curve = both_ways(growth, seed)
            branches += [orient(growth, curve)] if len(curve) > 1 else []
    return table(slider, across, up, branches, at)


def seeds(growth: Growth, x: float, y: float) -> Iterator[Point]:
    """Yield zeros of the growth rate, on lines across the plane and through (x, y)."""
    for level in (y, *LINES):
        if 0.0 <= level <= 1.0:
            for found in sign_changes(lambda a, b=level: growth((a, b)), LOOKS)[0]:  # type: ignore[misc]
                yield found, level
    for place in (x, *LINES):
        if 0.0 <= place <= 1.0:
            for found in sign_changes(lambda b, a=place: growth((a, b)), LOOKS)[0]:  # type: ignore[misc]
                yield place, found


def table(
    slider: Slider, x: Axis, y: Axis, branches: Sequence[Floats], at: Callable[[Point], Slider]
) -> xr.Dataset:
    """Return the curves as labelled arrays."""
    points = [(float(a), float(b)) for branch in branches for a, b in branch]
    count = [n for n, branch in enumerate(branches) for _ in branch]
    frequency = [leading_frequency(at(point)) for point in points]
    columns = {
        x.path: ([x.value(a) for a, _ in points], x.unit or "1", x.path),
        y.path: ([y.value(b) for _, b in points], y.unit or "1", y.path),
        "frequency": (frequency, "Hz", "frequency of the critical mode"),
    }
    data = {
        name: ("point", np.array(values, dtype=np.float64), {"units": unit, "long_name": meaning})
        for name, (values, unit, meaning) in columns.items()
    }
    branch = ("point", np.array(count, dtype=np.int64), {"long_name": "connected curve"})
    attributes: dict[str, Any] = {"x": x.path, "y": y.path, "growth_rate": growth_rate(slider)}
    for name, each in (("x", x), ("y", y)):
        attributes[f"{name}_own"] = present_value(slider, each.path)
        attributes[f"{name}_range"] = np.array([each.low, each.high])
        attributes[f"{name}_scale"] = "log" if each.logarithmic else "linear"
    return xr.Dataset({**data, "branch": branch}, attrs=attributes)


def near(point: Point, branch: Floats) -> bool:
    """Return whether a point lies on a known curve."""
    a, b = branch[:-1], branch[1:]
    along = b - a
    length = np.maximum(np.sum(along**2, axis=1), 1e-30)
    part = np.clip(np.sum((np.array(point) - a) * along, axis=1) / length, 0.0, 1.0)
    gap = np.hypot(*(a + part[:, None] * along - point).T)
    return bool(gap.min(initial=np.inf) < 0.25 * LONGEST_STEP)


def both_ways(growth: Growth, seed: Point) -> Floats:
    """Return the curve through a point, (n, 2), from end to end."""
    angles = np.linspace(-pi, pi, 17)
    values = [growth(beside(seed, angle, LONGEST_STEP)) for angle in angles]
    ways = [
        zero(growth, seed, LONGEST_STEP, a, b)
        for (a, f_a), (b, f_b) in pairwise(zip(angles, values, strict=True))
        if f_a * f_b < 0.0
    ]
    if not ways:
        return np.array([seed])
    there = list(follow(growth, seed, ways[0]))
    if (len(there) > 2 and there[-1] == seed) or len(ways) == 1:
        return np.array([seed, *there])
    back = list(follow(growth, seed, farthest(ways)))
    return np.array([*reversed(back), seed, *there])


def farthest(ways: Sequence[float]) -> float:
    """Return the direction that differs most from the first."""
    return max(ways[1:], key=lambda way: abs(turn(ways[0], way)))


def follow(growth: Growth, seed: Point, way: float) -> Iterator[Point]:
    """Yield the points of a curve from `seed` to the edge of the plane, or back to `seed`."""
    here, step, gone, start = seed, LONGEST_STEP, 0.0, way
    for _ in range(MOST_STEPS):
        found = ahead(growth, here, way, step)
        shorter = step > SHORTEST_STEP
        if shorter and (found is None or abs(turn(way, found)) > STRAIGHT):
            step = max(step / 2.0, SHORTEST_STEP)
            continue
        if found is None:
            return
        bent, way = abs(turn(way, found)), found
        last, here = here, beside(here, way, step)
        gone += step
        if not all(0.0 <= each <= 1.0 for each in here):
            # beyond the edge the growth rate stays constant: the curve leaves at a right angle
            edge = min(max(here[0], 0.0), 1.0), min(max(here[1], 0.0), 1.0)
            if (
                hypot(edge[0] - last[0], edge[1] - last[1]) > SHORTEST_STEP**2
            ):  # not yet at the edge
                yield edge
            return
        back = gone > 2.0 * LONGEST_STEP and hypot(seed[0] - last[0], seed[1] - last[1]) < step
        if back and abs(turn(start, way)) < pi / 2.0:  # `start` is ahead, not behind
            yield seed
            return
        yield here
        step = min(LONGEST_STEP, 1.5 * step) if bent < STRAIGHT / 3.0 else step


def ahead(growth: Growth, here: Point, way: float, step: float) -> float | None:
    """Return the direction (rad) of the next point, None if there is none."""
    for angle in AHEAD if step <= SHORTEST_STEP else AHEAD[:1]:
        values = [growth(beside(here, way + side, step)) for side in (-angle, angle)]
        if values[0] * values[1] < 0.0:
            return zero(growth, here, step, way - angle, way + angle)
    return None


def zero(growth: Growth, here: Point, step: float, low: float, high: float) -> float:
    """Return the direction between two in which the growth rate is zero a step away."""
    from scipy.optimize import brentq

    return float(
        brentq(lambda angle: growth(beside(here, angle, step)), low, high, xtol=CLOSE)  # type: ignore[no-untyped-call]
    )


def beside(point: Point, angle: float, step: float) -> Point:
    """Return the point one step away in a direction."""
    return point[0] + step * cos(angle), point[1] + step * sin(angle)


def turn(before: float, after: float) -> float:
    """Return the angle from one direction to another, between -pi and pi."""
    return (after - before + pi) % (2.0 * pi) - pi


def orient(growth: Growth, curve: Floats) -> Floats:
    """Orient a curve so that the growth rate is positive on its left."""
    middle = len(curve) // 2
    (x, y), (dx, dy) = curve[middle], curve[middle] - curve[middle - 1]
    left = atan2(dy, dx) + pi / 2.0
    sides = [growth(beside((x, y), left + way, 10.0 * SHORTEST_STEP)) for way in (0.0, pi)]
    return curve if sides[0] > sides[1] else curve[::-1]
