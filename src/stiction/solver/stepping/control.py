"""Newton's end and failure in both solvers, and the next step's size from a step's error.

Newton's method is Hairer & Wanner, Solving Ordinary Differential Equations II, section IV.8; the
control of step sizes is Gustafsson's, ACM Trans. Math. Softw. 20 (1994), 496.
"""

from __future__ import annotations

from math import sqrt

from stiction.friction.law import Vector
from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import inlined

# of a step before it fails: where it is not solved, 0.3^100 = 5e-53 is below RESOLUTION; where its
# error stays just above the tolerance, each try is 0.9 times as long, and 0.9^100 = 3e-5
ATTEMPTS = 100
# of the time, far below a float's resolution: motion goes on within a thin boundary layer
RESOLUTION = 1e-30
GROWTH = 2.0  # of step sizes, at most
SAFETY = 0.9  # of the size at which the next error would be the tolerance
LEAST_FACTOR = 0.2  # of step sizes, at least
LEAST_ERROR = 1e-10  # of the tolerance: added, so that an ease is finite
FAILED = 0.3  # of the size, where a step was not solved
CONTRACTS = 0.1  # of a correction to the last one: the Jacobian is kept
CALMEST = 3.0  # of eases that are kept: a smaller error than that begins no trend
PATIENCE = 3  # iterations that may diverge


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
    return 1.0 / sqrt(sqrt(error + LEAST_ERROR))


@inlined
def step_factor(error: float, most: float) -> float:
    """Return the factor for the step size, `most` at most, from the error over tolerance (M43)."""
    return min(most, max(LEAST_FACTOR, SAFETY * ease(error)))


@inlined
def motion_of(rate: Vector, change: Vector, accuracy: Accuracy) -> tuple[float, float]:
    """Return the motion (M42) of an elongation rate (m/s) that changes so fast (m/s^2), in m/s.

    It is at least the effect of rounding. The second is its square with the faster radian in place
    of both.
    """
    (x, y), (by_x, by_y) = rate, change
    apart, b_x, b_y = x * x + y * y, by_x * by_x, by_y * by_y
    square = b_x * accuracy.square_x + b_y * accuracy.square_y
    fast = (b_x + b_y) * min(accuracy.square_x, accuracy.square_y)
    return max(sqrt(apart + square), accuracy.least), apart + fast


@inlined
def trend(h: float, h_last: float, at_ease: float, before: float) -> float:
    """Return the factor from the trend of errors: one that has grown will grow on (M43).

    Given the sizes of the step and the last one (s), then the eases of their errors.
    """
    return max(LEAST_FACTOR, SAFETY * h / h_last * at_ease * at_ease / before)
