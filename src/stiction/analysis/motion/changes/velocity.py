"""Swings of the force that jumps of the drive's velocity make, where its motion is known.

Where a drive becomes faster, friction rises at once and comes down again while the contacts evolve;
where it becomes slower, or holds, friction falls at once. Thus the force has a peak soon after the
one jump, and a trough soon after the other, as in stick-slip, but without any slip. The peaks of
stick-slip come whenever the spring is loaded, wherever the jumps are.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.drive.measured_drive import measured_stretches
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.record import Record
from stiction.arrays import Floats, Indices
from stiction.drive import ConstantVelocity, Stretches, drive_stretches
from stiction.errors import ResultError
from stiction.recording.noise import seeming_motion

CHANGES = 0.05  # of the larger of two velocities: a drive that is to keep to one differs by less
SOON = 0.25  # of the stretch at the new velocity. So soon come a quarter of all cycles by chance
MOST_SWINGS = 0.75  # of all swings: then none of them is a cycle of stick-slip
NEAR = 0.02  # of a swing: noise places its peak no better
# Times that a drive becomes faster again in a swing: one that moves in short steps does so more
# often, and the spring is loaded over many of them
AGAIN = 2


class VelocityJump(NamedTuple):
    """A jump of the drive's velocity: when, until when the new one lasts (s), whether it rises."""

    time: float
    until: float
    rises: bool


def velocity_jumps(record: Record) -> list[VelocityJump]:
    """Return the jumps of a drive's velocity, in order of time: of a run, or as it was measured.

    They lie between stretches of constant velocity. None are known where the displacement was not
    measured.
    """
    end, found = float(record.time[-1]), _stretches(record)
    forward = _way(found, float(record.time[0]), end) >= 0.0
    jumps = []
    for (at, one), (until, two) in pairwise(found):
        if at >= end or not (isinstance(one, ConstantVelocity) and isinstance(two, type(one))):
            continue
        rise = two.velocity - one.velocity
        if abs(rise) > CHANGES * max(abs(one.velocity), abs(two.velocity)):
            jumps.append(VelocityJump(at, min(until, end), (rise > 0.0) == forward))
    return jumps


def _stretches(record: Record) -> Stretches:
    """Return the stretches of a run's drive, or those that its measured displacement shows."""
    if record.slider is not None:
        return drive_stretches(record.slider.motion)
    way = record.drive_position
    if way is None or not np.ptp(way) > seeming_motion(way):
        return ()
    try:
        return measured_stretches(record.time, way)
    except ResultError:
        return ()


def _way(stretches: Stretches, start: float, end: float) -> float:
    """Return how far a drive goes in its stretches of constant velocity, from `start` to `end`."""
    way = 0.0
    for until, course in stretches:
        lasts = max(min(until, end) - start, 0.0)
        way += course.velocity * lasts if isinstance(course, ConstantVelocity) else 0.0
        start = max(start, min(until, end))
    return way


def made_by_jumps(swings: CycleTable, jumps: list[VelocityJump]) -> bool:
    """Return whether jumps of the drive's velocity make the swings of a force: most, or all."""
    if not jumps or not len(swings):
        return False
    if np.median(_times_faster(swings, jumps)) > AGAIN:
        return False
    near = NEAR * swings["period"]
    peaks = _soon_after(swings["peak_time"], near, jumps, rises=True)
    troughs = _soon_after(swings["trough_time"], near, jumps, rises=False)
    return bool(np.mean(peaks | troughs) >= MOST_SWINGS)


def _times_faster(swings: CycleTable, jumps: list[VelocityJump]) -> Indices:
    """Return how often the drive becomes faster in each swing, in one jump or several."""
    before = [False, *(each.rises for each in jumps[:-1])]
    faster = [each.time for each, rose in zip(jumps, before, strict=True) if each.rises > rose]
    return np.searchsorted(faster, swings["trough_time"]) - np.searchsorted(faster, swings["start"])


def _soon_after(
    time: Floats, near: Floats, jumps: list[VelocityJump], *, rises: bool
) -> NDArray[np.bool_]:
    """Return which times (s), known to within `near` (s), come soon after a jump up, or down."""
    at = np.array([each.time for each in jumps])
    last = np.searchsorted(at, time + near, side="right") - 1
    lasts = np.array([each.until - each.time for each in jumps])
    such = np.array([each.rises is rises for each in jumps])
    soon = time - at[last] <= np.maximum(SOON * lasts[last], near)
    return np.asarray((last >= 0) & such[last] & soon)
