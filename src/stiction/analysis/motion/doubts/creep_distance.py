"""Whether the rises of the force show creep, or the effects of noise, filters and drifts."""

from __future__ import annotations

from math import inf

import numpy as np

from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.doubts.sampling import drawn_out, usual_fall
from stiction.analysis.motion.drift import Drift
from stiction.analysis.motion.metadata.loading_rate import rate_of_drift
from stiction.analysis.record import Record
from stiction.analysis.signals.digitised import resolution
from stiction.recording.noise import white_noise
from stiction.text.quantity.wording import in_words

# Standard deviations of noise, by which the force seems to rise too far while the spring is loaded
ON_BOTH_ENDS = 2.0
# Of the drive's way while a filter draws a slip out: creep that it shows of a mass at rest is 0.14
# to 0.36 times this in 9 of 10 random records behind one pole, and less behind more
LAG = 0.4


def unseen_creep(record: Record, cycles: CycleTable, drift: Drift | None) -> str:
    """Return why the distance crept is not seen, or "": something else makes as much of it."""
    if not (spring := _spring(record)):
        return ""
    seen = float(np.nanmedian(cycles["creep_distance"]))
    ways = {
        "noise and the time between samples hide about {} of it": hidden_way(record),
        "a filter of the load cell may look like {} of creep where the mass rests": way_of_lag(
            record, cycles
        ),
        "a drift of the force may look like {} of creep": _way_of_drift(spring[0], cycles, drift),
    }
    if not 0.0 <= seen < sum(ways.values()):
        return ""
    largest = max(ways, key=lambda why: ways[why])
    return largest.format(in_words(ways[largest], "m", 2))


def hidden_way(record: Record) -> float:
    """Return how much of creep and slip noise and samples hide, m; 0 where the position is known.

    The largest force is too early, and too high, by noise; the mass seems to slip from there on. Of
    100 random records creep is so much too short in the median that 0.63 times this is missing, and
    1.2 times in 5.
    """
    if not (spring := _spring(record)):
        return 0.0
    stiffness, speed = spring
    force = ON_BOTH_ENDS * white_noise(record.force) + resolution(record.force)
    return float(force / stiffness + speed / record.sample_rate)


def way_of_lag(record: Record, cycles: CycleTable) -> float:
    """Return how much creep a filter of the load cell shows where the mass rests, m.

    It lags behind the force, so that after a trough the rise seems to begin slowly. Zero where
    slips last no longer than mass and stiffness as stated have it, or the position is known.
    """
    if not (spring := _spring(record)) or not len(cycles):
        return 0.0
    stiffness, speed = spring
    stated = stiffness / record.mass if record.mass else inf
    return LAG * speed * drawn_out(usual_fall(record, cycles), stated)


def _way_of_drift(stiffness: float, cycles: CycleTable, drift: Drift | None) -> float:
    """Return how much creep a drift shows in the median rise of the force, m."""
    rise = float(np.median(cycles["peak_time"] - cycles["start"]))
    return abs(rate_of_drift(cycles, drift)) * rise / stiffness


def _spring(record: Record) -> tuple[float, float] | None:
    """Return the stiffness (N/m) and drive speed (m/s) that turn a force into a displacement.

    None where the position is known, or they are not.
    """
    if record.position is not None or not record.stiffness or not record.drive_velocity:
        return None
    return record.stiffness, abs(record.drive_velocity)
