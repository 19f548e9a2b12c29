"""All properties of the apparatus that a record shows, beside the stated ones."""

from __future__ import annotations

from collections.abc import Sequence
from math import nan, pi

import numpy as np

from stiction.analysis.motion.changes.initial_rest import first_reading
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.drift import Drift
from stiction.analysis.motion.metadata.drive_velocity import drive_velocity
from stiction.analysis.motion.metadata.loading_rate import loading_rates
from stiction.analysis.motion.metadata.quantity import ALIKE_VALUES, FEWEST_SAMPLES, StatedQuantity
from stiction.analysis.motion.metadata.stiffness_over_mass import stiffness_over_mass
from stiction.analysis.record import Record
from stiction.analysis.signals.clipping import FlatEnd
from stiction.analysis.signals.correlated_noise import ERRORS_997
from stiction.analysis.signals.robust import largest_magnitude
from stiction.analysis.signals.straight_line import line

SEEN = 0.4  # of the sample rate: a faster oscillation is lost, or seen at another frequency
AT_REST, ZERO_READING = 0.02, 1e-12  # of the largest force: a reading at rest, and one of zero


def compare_metadata(
    record: Record, kind: str, cycles: CycleTable, drift: Drift | None, ends: Sequence[FlatEnd]
) -> tuple[StatedQuantity, ...]:
    """Return all properties of the apparatus that a record shows, beside the stated ones.

    Parameters
    ----------
    record : Record
        With what is stated.
    kind : str
        The kind of motion.
    cycles : CycleTable
        The cycles of the record.
    drift : Drift or None
        Of the force, if it shows one.
    ends : sequence of FlatEnd
        At which the force is cut off: there a fall seems to begin too early.
    """
    found = (
        None if ends else stiffness_over_mass(record, kind, cycles),
        *loading_rates(record, kind, cycles, drift),
        drive_velocity(record),
        _normal_load(record),
        _transverse_frequency(record),
        _zero(record),
        _drift(cycles, drift),
    )
    return tuple(each for each in found if each is not None)


def _normal_load(record: Record) -> StatedQuantity | None:
    """Compare the mean of the measured normal load with the stated one, not with itself."""
    if record.load is None or not len(record):
        return None
    found, spread = float(record.load.mean()), float(record.load.std())
    stated = record.stated_load or nan
    how = "mean of its channel, with its spread"
    return StatedQuantity(
        "normal load", "N", found, spread, stated, 1 - ALIKE_VALUES, 1 + ALIKE_VALUES, how
    )


def _transverse_frequency(record: Record) -> StatedQuantity | None:
    """Compare the highest frequency that the record shows with the transverse one.

    That is (k_across/m)^1/2 / 2 pi; near the first slip the oscillation is slower.
    """
    if not record.stiffness_across or not record.mass or len(record) < FEWEST_SAMPLES:
        return None
    frequency = (record.stiffness_across / record.mass) ** 0.5 / (2.0 * pi)
    highest = SEEN * record.sample_rate
    sensor = (record.sensors or {}).get("force")
    how = "0.4 of the sample rate, or the sensor's cut-off"
    shown = highest if sensor is None else min(highest, sensor.cut_off)
    name = "transverse natural frequency"
    return StatedQuantity(name, "Hz", shown, nan, frequency, 1.0, float("inf"), how)


def _zero(record: Record) -> StatedQuantity | None:
    """Return the reading with which a record begins, where that is constant: a zero perhaps.

    It is none where the drive loads the spring from the first sample on.
    """
    some = first_reading(record.force)
    if not len(some) or len(record) < 4 * len(some):
        return None
    largest = largest_magnitude(record.force)
    read, spread = float(np.median(some)), float(np.std(some))
    read = read if abs(read) > ZERO_READING * largest else 0.0
    if not abs(read) < AT_REST * largest or spread > AT_REST * largest:
        return None
    its = line(record.time[: len(some)], some)
    if abs(its.slope) > ERRORS_997 * its.slope_error:
        return None
    stated, how = 0.0 if record.zero is not None else nan, "first readings, with their spread"
    return StatedQuantity("zero", "N", read, spread, stated, nan, nan, how)


def _drift(cycles: CycleTable, drift: Drift | None) -> StatedQuantity | None:
    """Return the steady change of the force."""
    if drift is None:
        return None
    how = "line through the middles of cycles" if len(cycles) else "second half of the sliding"
    return StatedQuantity("drift of the force", "N/s", drift.rate, drift.error, nan, nan, nan, how)
