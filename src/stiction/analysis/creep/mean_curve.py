"""The mean creep curve of a record, and its uncertainty beside the scatter of its phases."""

from __future__ import annotations

from math import exp, pi

import numpy as np

from stiction.analysis.creep.curve import mean_creep
from stiction.analysis.creep.misalignment import Misalignment
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import ERRORS_95
from stiction.analysis.signals.digitised import resolution
from stiction.arrays import Floats, xr
from stiction.errors import ResultError
from stiction.recording.noise import ROUNDING_SPREAD, rounding_error
from stiction.text.quantity.wording import in_words

TWO_CODES = 0.25  # steps^2: so much may peaks of one height vary, read as either of two codes
COARSE = 0.01  # of the force's range: steps that hide creep
BACKWARD, SOME = 0.02, 0.25  # of the drive velocity; of the bins: limits of backward creep


def calibrate(record: Record, cycles: xr.Dataset, found: Misalignment | None = None) -> Record:
    """Return a record with the stiffness seen in its own loading, unless it has a position.

    It is the stiffness fitted with the misalignment, or that of the even loading in the first half
    of each rise (the median over cycles). Creep is V minus the rate of force over stiffness: an
    error of a few per cent in a stated stiffness would hide it.
    """
    if record.position is not None:
        return record
    if found is not None:
        return record.model_copy(update={"stiffness": found.stiffness})
    shown = cycles["stiffness"].values
    shown = shown[np.isfinite(shown)]
    if not len(shown) or not np.median(shown) > 0.0:
        return record
    return record.model_copy(update={"stiffness": float(np.median(shown))})


def mean_curve(curves: xr.Dataset, record: Record, stated: Record) -> xr.Dataset:
    """Return the mean creep curve, if it does not go backwards.

    Counted from the loading (`calibrate`), creep that is slower there than on average is negative.
    It is backward if it is negative with the stiffness as stated, too.
    """
    if not np.isfinite(curves["velocity"].values).any():
        if not curves.sizes["phase"]:
            raise ResultError("no whole stick phase ends in a slip")
        raise ResultError("no stick phase has enough samples")
    mean = mean_creep(curves)
    velocity, error = (mean[name].values for name in ("velocity", "velocity_error"))
    V = record.drive_velocity or 0.0
    ratio = (record.stiffness or 1.0) / (stated.stiffness or record.stiffness or 1.0)
    most = np.fmax(velocity, V - ratio * (V - velocity))
    backward = np.mean(most < -ERRORS_95 * np.nan_to_num(error) - BACKWARD * V)
    step = resolution(record.force)
    if backward > SOME and step > COARSE * float(np.ptp(record.force)):
        raise ResultError(
            f"not determined: the force is recorded in steps of {in_words(step, 'N')}, too coarse "
            "for creep"
        )
    if backward > SOME and record.position is None:
        raise ResultError(
            "not determined: the mass would creep against the drive; stiffness and drive velocity "
            "contradict this force"
        )
    return mean


def with_base(mean: xr.Dataset, record: Record, stated: Record) -> xr.Dataset:
    """Return mean creep with the error of the stiffness that was taken from the loading.

    If the stated stiffness is right, the mass creeps while it is loaded, by the difference.
    """
    if record.position is not None or not stated.stiffness or not record.stiffness:
        return mean
    base = (record.drive_velocity or 0.0) * abs(1.0 - record.stiffness / stated.stiffness)
    return _with_error(mean, base)


def with_rounding(mean: xr.Dataset, record: Record, cycles: xr.Dataset) -> xr.Dataset:
    """Return mean creep whose error has the steps of a force from which it was read.

    Where all slips begin within a step, every phase is rounded at the same times before slip: the
    scatter of the phases does not show it. The rounding of a half of a bin is the less the more
    steps the force passes there.
    """
    step = resolution(record.force) if record.position is None else 0.0
    if not step or not record.stiffness or not record.drive_velocity:
        return mean
    spread = max((float(cycles["peak"].std()) / step) ** 2 - TWO_CODES, 0.0)
    alike = exp(-2.0 * pi**2 * spread)  # of the first harmonic, as in `dither_remainder`
    lasts = (mean["begin"] - mean["end"]).values
    loading = record.drive_velocity - mean["velocity"].values
    passed = 0.5 * np.abs(loading) * lasts * record.stiffness / step
    place = rounding_error(record.force, step) * alike / record.stiffness
    return _with_error(mean, 8.0**0.5 * place / lasts / np.maximum(passed, 1.0))


def with_slip_time(mean: xr.Dataset, record: Record) -> xr.Dataset:
    """Return mean creep with the error of the slip's time in the bin next to the slip.

    It is known to a sample, for all phases alike. With a part of it more, or less, the last bin
    has more or less of a motion that goes as fast as the drive. A bin before it has not.
    """
    V, velocity = record.drive_velocity, float(mean["velocity"][0])
    if V is None or mean["end"][0] > 0.0:
        return mean
    lasts = float(mean["begin"][0] - mean["end"][0])
    unsure = np.zeros(mean.sizes["bin"])
    unsure[0] = ROUNDING_SPREAD * abs(V - velocity) / record.sample_rate / lasts
    return _with_error(mean, unsure)


def _with_error(mean: xr.Dataset, other: Floats | float) -> xr.Dataset:
    """Return mean creep whose error has another one (m/s) beside its own."""
    own = mean["velocity_error"]
    return mean.assign(velocity_error=own.copy(data=np.hypot(np.nan_to_num(own), other)))
