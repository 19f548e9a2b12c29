"""The velocity of the drive by its displacement, which may turn or rest."""

from __future__ import annotations

from math import nan

import numpy as np

from stiction.analysis.drive.measured_drive import measured_stretches
from stiction.analysis.motion.metadata.quantity import ALIKE_VALUES, FEWEST_SAMPLES, StatedQuantity
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import correlation_time, standard_error
from stiction.analysis.signals.straight_line import line
from stiction.arrays import Floats
from stiction.errors import ResultError

# Of a record, for the speed of a drive that may turn, or rest within noise
PARTS_OF_RECORD = 200, 66, 25
TO_AND_FRO = 0.8  # of its reach: a drive that comes less far on the whole turns
HELD = 0.01  # of a drive's largest speed: in parts that are slower it rests
NOISE = 20.0  # standard deviations, by which means of the displacement do not differ
STARTS = 3.0  # times what noise alone may move by: a drive that rests between its motions


def drive_velocity(record: Record) -> StatedQuantity | None:
    """Compare the slope of the drive's displacement with the stated velocity.

    A drive that steps from one velocity to another has no slope; the stated one is one of them.
    """
    if record.drive_position is None or len(record) < FEWEST_SAMPLES:
        return None
    way, stated = line(record.time, record.drive_position), record.stated_velocity or nan
    error = standard_error(way.deviations(record.time, record.drive_position))
    whole = StatedQuantity(
        "drive velocity", "m/s", abs(way.slope), error / float(record.time.std()), stated,
        1 - ALIKE_VALUES, 1 + ALIKE_VALUES, "slope of the drive's displacement",
    )  # fmt: skip
    if whole.agrees:  # a drive that jerks, or rings, rests and turns as well
        return whole
    if _steps_to(stated, record.time, record.drive_position):
        return None
    divided = [
        _speeds_of_parts(record.time, record.drive_position, most) for most in PARTS_OF_RECORD
    ]
    speeds, net, reach, rests = next((each for each in divided if each[-1]), divided[0])
    turns = net < TO_AND_FRO * reach
    if not rests and not turns and whole.found * record.duration >= TO_AND_FRO * reach:
        return whole
    how = f"median speed of its displacement{', to and fro' if turns else ' in motion'}"
    error = float(speeds.std()) / len(speeds) ** 0.5
    return whole._replace(found=float(np.median(speeds)), error=error, how=how)


def _steps_to(speed: float, time: Floats, position: Floats) -> bool:
    """Return whether a drive steps between velocities, one of which is such a speed (m/s)."""
    try:
        speeds = [abs(each.velocity) for _, each in measured_stretches(time, position)]
    except ResultError:
        return False
    several = max(speeds) - min((each for each in speeds if each), default=0.0)
    near = [abs(each - speed) <= ALIKE_VALUES * speed for each in speeds]
    return any(near) and several > ALIKE_VALUES * max(speeds)


def _speeds_of_parts(
    time: Floats, position: Floats, most: int
) -> tuple[Floats, float, float, bool]:
    """Return the speed in so many equal parts of a record (m/s), and how far they go (m).

    That is from the first to the last, and in all, beyond noise. Parts in which the drive turns are
    the fewest: the median speed is that between the turns. Parts in which it rests, as in a hold,
    are left out; the last value is whether there are any.
    """
    parts = min(most, len(time) // FEWEST_SAMPLES)
    times, positions = (np.array_split(each, parts) for each in (time, position))
    slopes, middles, left = [], [], []
    for t, x in zip(times, positions, strict=True):
        way = line(t, x)
        slopes.append(way.slope)
        middles.append(way.level)
        left.append(way.deviations(t, x))
    rest = np.concatenate(left)
    noise = float(rest.std()) * (correlation_time(rest) * parts / len(rest)) ** 0.5
    reach = float(np.ptp(middles)) - NOISE * noise
    speeds, net = np.abs(slopes), abs(middles[-1] - middles[0])
    still = NOISE * noise * parts / float(time[-1] - time[0])  # six errors of a slope
    moves = speeds > max(still, HELD * float(speeds.max()))
    if moves.all() or not moves.any() or np.median(speeds[moves]) < STARTS * still:
        return speeds, net, reach, False
    return speeds[moves], net, reach, True
