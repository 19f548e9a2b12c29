"""What both solvers ask of Newton's method, and how the error of a step sets the next one's size.

Newton's method is Hairer & Wanner, Solving Ordinary Differential Equations II, section IV.8; the
control of step sizes is Gustafsson's, ACM Trans. Math. Softw. 20 (1994), 496.
"""

from __future__ import annotations

from math import inf, log, sqrt
from typing import NamedTuple

from stiction.friction.law import Vector
from stiction.solver.compilation.jit import inlined
from stiction.solver.compilation.stand_in import called_from_both
from stiction.solver.state import Accuracy, Limit, elsewhere

ATTEMPTS = 100  # of a step before it fails; 0.4^100 is below the resolution of any float
# of the time, far below a float's resolution: motion goes on within a thin boundary layer
RESOLUTION = 1e-30
GROWTH = 2.0  # of step sizes, at most
FAILED = 0.3  # of the size, where a step was not solved
CONTRACTS = 0.1  # of a correction to the last one: the Jacobian is kept
CALMEST = 3.0  # of eases that are kept: a smaller error than that begins no trend
PATIENCE = 3  # iterations that may diverge


class Time(NamedTuple):
    """Time (s), how much is left of the segment, and whether drive or load vary in it."""

    t: float
    left: float
    varies: bool


ASKED = -1.0  # in place of the longest step of a limit
NEAR = 0.01  # of the slip speed: at most so far from steady sliding
ROUNDING = 1e-16  # of the slip speed: it is no closer to steady sliding
LATE = 1e-6  # of the time left: the size of steps from which the modes are asked for
AGAIN = 1e3  # of that at which they were: steady sliding is then known better
SOON = 0.02  # of the time left, where drive or load vary: the modes are others then


@inlined
def settled(size: float, rate: float, enough: float) -> bool:
    """Return whether corrections are, or the next one will be, negligible (M33).

    `rate` is the size of a correction over that of the last one; with a new Jacobian, which
    squares the error, the size itself.
    """
    return size < enough or size * rate < enough


@inlined
def diverging(iteration: int, growth: float) -> bool:
    """Return whether corrections grow, after the first few."""
    return iteration > PATIENCE and growth > 1.0


@inlined
def ease(error: float) -> float:
    """Return the power -1/4 of the local error over its tolerance, which falls with h^4."""
    return 1.0 / sqrt(sqrt(error + 1e-10))


@inlined
def step_factor(error: float, limit: float) -> float:
    """Return the factor for the step size from the error over tolerance (M43)."""
    return min(limit, max(0.2, 0.9 * ease(error)))


@inlined
def motion_of(rate: Vector, change: Vector, held: Accuracy) -> tuple[float, float]:
    """Return the motion (M42) of an elongation rate (m/s) that changes so fast (m/s^2), in m/s.

    It is at least the effect of rounding. The second is its square with the faster radian in place
    of both.
    """
    (x, y), (by_x, by_y) = rate, change
    apart, b_x, b_y = x * x + y * y, by_x * by_x, by_y * by_y
    square = b_x * held.square_x + b_y * held.square_y
    fast = (b_x + b_y) * min(held.square_x, held.square_y)
    return max(sqrt(apart + square), held.least), apart + fast


@inlined
def limit_there(
    limit: Limit,
    h: float,
    at: Time,
    apart: float,
    motion: float,
    slip: float,
    held: Accuracy,
) -> Limit:
    """Return the limit of a step of `h`, given that of the step before.

    `motion` is that about steady sliding (M42), `apart` the square of it in a radian of the faster
    spring, `slip` the slip speed. Near steady sliding a step may be longer than the growth takes,
    which it then damps: the modes are asked for. The second number is then by how many factors of
    e a disturbance must grow until errors no longer hide it.
    """
    near = NEAR * slip
    if limit[1] == inf or not apart <= near * near:
        return elsewhere(limit)
    if h < LATE * at.left or (at.t if at.varies else h) <= limit[1]:
        return limit
    hidden = max(held.least, held.tolerance * min(held.speed + slip, motion))
    return ASKED, max(1.0, log(hidden / (sqrt(apart) + ROUNDING * slip)))


@called_from_both
def known_up_to(h: float, at: Time) -> float:
    """Return the size of steps, or the time, up to which the modes need not be asked for again."""
    return at.t + SOON * at.left if at.varies else AGAIN * h


@inlined
def within_limit(h: float, limit: Limit) -> float:
    """Return the size of a step that is no longer than the longest, where that is known."""
    return min(h, limit[0]) if limit[0] > 0.0 else h


@inlined
def trend(h: float, h_last: float, at_ease: float, before: float) -> float:
    """Return the factor from the trend of errors: one that has grown will grow on (M43).

    Given the sizes of the step and the last one (s), then the eases of their errors.
    """
    return max(0.2, 0.9 * h / h_last * at_ease * at_ease / before)
