"""How long a step about steady sliding may be, and when a loop asks for that (M43a).

Near steady sliding a step may be longer than a disturbance takes to grow, which it then damps. How
long it may be follows from the modes (see `amplification`), for which a loop asks where steps are
long, and again where the modes may be others.
"""

from __future__ import annotations

from math import inf, log, sqrt
from typing import NamedTuple

from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import inlined
from stiction.solver.compilation.stand_in import called_from_both

# The longest step that shows how disturbances of steady sliding grow (M43a), s; and the size of
# steps, or where drive or load vary the time, up to which it need not be asked for again
Limit = tuple[float, float]
NO_LIMIT: Limit = (inf, -inf)
NEVER_ASKED: Limit = (inf, inf)  # of what lands again at a known time
ASKED = -1.0  # in place of the longest step of a limit
NEAR_STEADY = 0.01  # of the slip speed: at most so far from steady sliding
ROUNDING_OF_SLIP = 1e-16  # of the slip speed: it is no closer to steady sliding
LATE = 1e-6  # of the time left: the size of steps from which the modes are asked for
AGAIN = 1e3  # of that at which they were: steady sliding is then known better
SOON = 0.02  # of the time left, where drive or load vary: the modes are others then


class Time(NamedTuple):
    """Time (s), how much is left of the segment, and whether drive or load vary in it."""

    t: float
    left: float
    varies: bool


@inlined
def elsewhere(limit: Limit) -> Limit:
    """Return the limit away from steady sliding: none, to be asked for where it is near again."""
    return limit if limit[1] == inf else NO_LIMIT


@inlined
def limit_there(
    limit: Limit,
    h: float,
    at: Time,
    apart: float,
    motion: float,
    slip: float,
    accuracy: Accuracy,
) -> Limit:
    """Return the limit of a step of `h`, given that of the step before.

    `motion` is that about steady sliding (M42), `apart` the square of it in a radian of the faster
    spring, `slip` the slip speed. Where the modes are asked for, the second number is by how many
    factors of e a disturbance must grow until errors no longer hide it.
    """
    near = NEAR_STEADY * slip
    if limit[1] == inf or not apart <= near * near:
        return elsewhere(limit)
    if h < LATE * at.left or (at.t if at.varies else h) <= limit[1]:
        return limit
    hidden = max(accuracy.least, accuracy.tolerance * min(accuracy.speed + slip, motion))
    return ASKED, max(1.0, log(hidden / (sqrt(apart) + ROUNDING_OF_SLIP * slip)))


@called_from_both
def known_up_to(h: float, at: Time) -> float:
    """Return the size of steps, or the time, up to which the modes need not be asked for again."""
    return at.t + SOON * at.left if at.varies else AGAIN * h


@inlined
def within_limit(h: float, limit: Limit) -> float:
    """Return the size of a step that is no longer than the longest, where that is known."""
    return min(h, limit[0]) if limit[0] > 0.0 else h
