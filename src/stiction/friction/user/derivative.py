"""The derivative of a law's coefficient by differences, with a bound of its error; its jumps."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from math import inf
from typing import NamedTuple

EPS = 2.2e-16
NEAR_REST = (1e-12, 1e-13, 1e-14, 1e-15)  # m/s, slower than a law can be resolved
# shares of a fall that a tenth of the speed leaves: 0.1 if proportional to it, 1 of a step
STEEP, STEP = 0.15, 0.97
REACHES = tuple(10.0 ** (-i / 2) for i in range(1, 13))  # of a difference, relative


def derivative(function: Callable[[float], float], v: float) -> tuple[float, float]:
    """Return the derivative by differences, and an error bound.

    The differences are central, one-sided at v = 0. The bound adds rounding and truncation, which
    halving the step reveals; of several steps the most accurate counts.
    """
    best = (0.0, inf)
    for reach in REACHES:
        h = reach * v or 1e-2 * reach * reach
        coarse, fine = _difference(function, v, h), _difference(function, v, 0.5 * h)
        rounding = 16.0 * EPS * (abs(function(v)) + abs(v * fine)) / h
        error = (2.0 if v > 0.0 else 4.0) * abs(fine - coarse) + rounding
        if error < best[1]:
            best = fine, error
    return best


def _difference(function: Callable[[float], float], v: float, h: float) -> float:
    if v == 0.0:
        return (4.0 * function(h) - 3.0 * function(0.0) - function(2.0 * h)) / (2.0 * h)
    return (function(v + h) - function(v - h)) / ((v + h) - (v - h))


def is_steep_at_rest(function: Callable[[float], float]) -> bool:
    """Return whether a function falls infinitely fast from its value at 0, as 1 - sqrt(v) does.

    Its fall from 0 then becomes less than ten times smaller from one decade to the next, and does
    become smaller: a step at 0 is not a slope.

    >>> is_steep_at_rest(lambda v: 0.3 - v**0.5), is_steep_at_rest(lambda v: 0.3 - 1e6 * v)
    (True, False)
    >>> is_steep_at_rest(lambda v: 0.3 + v**0.5)
    False
    """
    falls = [function(0.0) - function(v) for v in NEAR_REST]
    if not falls[-1] > 64.0 * EPS * abs(function(0.0)):
        return False
    return all(STEEP * a < b < STEP * a for a, b in pairwise(falls))


class Jump(NamedTuple):
    """The jump of a function: where it is, and the values on both sides."""

    at: float
    before: float
    after: float


def jump(
    function: Callable[[float], float],
    slope: Callable[[float], float],
    low: float,
    high: float,
    least: float,
) -> Jump | None:
    """Return a jump of a function between two places, if it is larger than `least`.

    The interval is halved towards the change that the slope does not explain: it vanishes with the
    width of the interval unless there is a jump.
    """

    def unexplained(a: float, b: float) -> float:
        return abs(function(b) - function(a) - 0.5 * (b - a) * (slope(a) + slope(b)))

    while unexplained(low, high) > least:
        middle = 0.5 * (low + high)
        if not low < middle < high:  # floats that are neighbours
            return Jump(high, function(low), function(high))
        first, second = unexplained(low, middle), unexplained(middle, high)
        low, high = (low, middle) if first > second else (middle, high)
    return None
