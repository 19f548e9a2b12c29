"""Strokes of a drive that goes back and forth, from its displacement or from the force."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from stiction.analysis.record import Record
from stiction.arrays import Floats
from stiction.recording.noise import seeming_motion
from stiction.recording.strokes import strokes as strokes_of

# The lesser of both levels over the larger; share of time between half of either, 0.23 for a sine
# about zero, 0.25 for a sawtooth; least share of time on either side
BALANCED, BETWEEN, EITHER = 0.3, 0.15, 0.1
# A passage from one level to the other is as slow up as down where a drive turns: by how much both
# may differ, and the rate over stiffness times drive velocity where the mass sticks meanwhile
AS_SLOW, ALMOST, AT_MOST = 1.25, 0.75, 1.15
QUICKER = 3.0  # times: then the one passage is a slip and the other a loading


def strokes(record: Record) -> tuple[float, float] | None:
    """Return the typical force (N) of either direction, if the drive turns round; else None."""
    return _by_displacement(record) or _by_force(record)


def _by_displacement(record: Record) -> tuple[float, float] | None:
    """Return the median force of the strokes forth and back of a drive that was recorded."""
    at = record.drive_position
    if at is None or not np.ptp(at) > seeming_motion(at):
        return None
    found = strokes_of(at)
    ways = [[record.force[each.samples] for each in found if each.way == way] for way in (1, -1)]
    if not all(ways):
        return None
    forth, back = (float(np.median(np.concatenate(parts))) for parts in ways)
    return forth, back


def _by_force(record: Record) -> tuple[float, float] | None:
    """Return the typical force of either sign, if it stays at both or passes slowly both ways.

    A vibration about zero stays at neither, and a mass on its spring passes in less than its own
    period. A force that only once goes from negative to positive may be a first loading with an
    untared zero.
    """
    force = record.force
    forth, back = force[force > 0.0], force[force < 0.0]
    if min(len(forth), len(back)) < EITHER * len(force):
        return None
    high, low = float(np.median(forth)), float(np.median(back))
    if min(high, -low) < BALANCED * max(high, -low):
        return None
    side = np.where(force > 0.5 * high, 1, np.where(force < 0.5 * low, -1, 0))
    up, down = _passages(record.time, side)
    untared = len(up) + len(down) < 2 and len(up) == 1
    if untared or (len(up) and len(down) and _is_slip(record, up, down)):
        return None
    stays = float(np.mean(side == 0)) <= BETWEEN
    return (high, low) if stays or _is_driven(record, up, down, 0.5 * (high - low)) else None


def _passages(time: Floats, side: Floats) -> tuple[Floats, Floats]:
    """Return the durations of passages from the lower level to the higher (s), and back."""
    at = np.flatnonzero(side)
    lasts: dict[int, list[float]] = {1: [], -1: []}
    for first, last in pairwise(at[_ends(side[at])]):
        if side[first] != side[last]:
            lasts[int(side[last])].append(float(time[last] - time[first]))
    return np.array(lasts[1]), np.array(lasts[-1])


def _ends(passed: Floats) -> Floats:
    """Return which of the sides are the last before a change, or the first after it."""
    turns = np.flatnonzero(np.diff(passed))
    return np.unique(np.concatenate([turns, turns + 1]))


def _is_slip(record: Record, up: Floats, down: Floats) -> bool:
    """Return whether the force falls far more quickly than it rises, as in a slip."""
    step = float(np.median(np.diff(record.time)))
    return float(np.median(up)) > QUICKER * (float(np.median(down)) + 2.0 * step)


def _is_driven(record: Record, up: Floats, down: Floats, height: float) -> bool:
    """Return whether a force passes both ways as the drive loads the spring, not as a mass swings.

    So does a drive that turns: both ways at the rate that is stated, or, where mass and stiffness
    are stated, for longer than a period of the mass.
    """
    if not len(up) or not len(down):
        return False
    rising, falling = float(np.median(up)), float(np.median(down))
    if max(rising, falling) > AS_SLOW * min(rising, falling):
        return False
    if (period := record.stated_period) is not None:
        return min(rising, falling) > period
    least, most = ALMOST * record.loading_rate, AT_MOST * record.loading_rate
    return all(least < height / each < most for each in (rising, falling))
