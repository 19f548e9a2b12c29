"""Tracing of a curve on which a function in the plane is zero, through folds and corners.

The next point is the change of sign on a circle about the present point (a spherical constraint:
Yamamura, IEEE Trans. Circuits Syst. I 40 (1993), 448). The plane is the unit square.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from math import atan2, cos, hypot, pi, sin

import numpy as np

from stiction.arrays import Floats

Point = tuple[float, float]
Growth = Callable[[Point], float]  # beyond an edge of the plane, its value at the edge

LONGEST, SHORTEST = 0.02, 1e-4  # steps along the curve
STRAIGHT = 0.3  # rad; where the curve turns more in a step, the step is shortened
AHEAD = (0.4, 1.0, 1.6, 2.2)  # rad to both sides of straight ahead, searched in this order
MOST = 4000  # steps along one curve


def near(point: Point, branch: Floats) -> bool:
    """Return whether a point lies on a known curve."""
    a, b = branch[:-1], branch[1:]
    along = b - a
    length = np.maximum(np.sum(along**2, axis=1), 1e-30)
    part = np.clip(np.sum((np.array(point) - a) * along, axis=1) / length, 0.0, 1.0)
    gap = np.hypot(*(a + part[:, None] * along - point).T)
    return bool(gap.min(initial=np.inf) < 0.25 * LONGEST)


def both_ways(growth: Growth, seed: Point) -> Floats:
    """Return the curve through a point, (n, 2), from end to end."""
    angles = np.linspace(-pi, pi, 17)
    values = [growth(beside(seed, angle, LONGEST)) for angle in angles]
    ways = [
        zero(growth, seed, LONGEST, a, b)
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
    here, step, gone, start = seed, LONGEST, 0.0, way
    for _ in range(MOST):
        found = ahead(growth, here, way, step)
        shorter = step > SHORTEST
        if shorter and (found is None or abs(turn(way, found)) > STRAIGHT):
            step = max(step / 2.0, SHORTEST)
            continue
        if found is None:
            return
        bent, way = abs(turn(way, found)), found
        last, here = here, beside(here, way, step)
        gone += step
        if not all(0.0 <= each <= 1.0 for each in here):
            # beyond the edge the growth rate stays constant: the curve leaves at a right angle
            edge = min(max(here[0], 0.0), 1.0), min(max(here[1], 0.0), 1.0)
            if hypot(edge[0] - last[0], edge[1] - last[1]) > SHORTEST**2:  # not yet at the edge
                yield edge
            return
        back = gone > 2.0 * LONGEST and hypot(seed[0] - last[0], seed[1] - last[1]) < step
        if back and abs(turn(start, way)) < pi / 2.0:  # `start` is ahead, not behind
            yield seed
            return
        yield here
        step = min(LONGEST, 1.5 * step) if bent < STRAIGHT / 3.0 else step


def ahead(growth: Growth, here: Point, way: float, step: float) -> float | None:
    """Return the direction (rad) of the next point, None if there is none."""
    for angle in AHEAD if step <= SHORTEST else AHEAD[:1]:
        values = [growth(beside(here, way + side, step)) for side in (-angle, angle)]
        if values[0] * values[1] < 0.0:
            return zero(growth, here, step, way - angle, way + angle)
    return None


def zero(growth: Growth, here: Point, step: float, low: float, high: float) -> float:
    """Return the direction between two in which the growth rate is zero a step away."""
    from scipy.optimize import brentq

    return float(
        brentq(lambda angle: growth(beside(here, angle, step)), low, high, xtol=1e-11)  # type: ignore[no-untyped-call]
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
    sides = [growth(beside((x, y), left + way, 10.0 * SHORTEST)) for way in (0.0, pi)]
    return curve if sides[0] > sides[1] else curve[::-1]
