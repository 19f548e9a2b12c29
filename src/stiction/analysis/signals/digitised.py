"""Signals that are read in steps, as a converter of few bits gives them."""

from __future__ import annotations

import numpy as np

from stiction.arrays import Floats, Indices, compute_once
from stiction.recording.noise import dither_remainder, lattice, rounding_error

MANY, COARSE = 100_000, 1e-4  # samples examined for steps; smallest step, over the signal's range
FIRST_VALUES = 1000  # values, among which those of a continuous signal are nearer than that already
# Steps of a converter: the median fall that rounding makes. Without a wave it is one step, without
# a line up to 1.50, in 482 staircases with noise up to 0.3 steps
ROUNDED = 1.6
# Values that a slow sensor gives several times each, as many times but for a jitter of its clock;
# those of a ramp through steps of a converter differ by one step each
ENOUGH_VALUES, JITTER, ONE_STEP = 16, 2, 1.5


@compute_once
def resolution(values: Floats) -> float:
    """Return the step that the values of a signal may be rounded to; 0 if it is nearly continuous.

    That is the step of the `lattice` of all values, up to 14 bits. But that needs a dozen codes,
    and several samples of each. A force that stays within few steps, or of few samples, has none
    and may be rounded all the same: there it is the smallest step between values, an upper bound
    of the rounding. Of a ramp without noise it is the change from sample to sample.
    """
    some = values[:MANY]
    if step := lattice(some):
        return step
    if len(some) < 2:
        return 0.0
    least = COARSE * float(np.ptp(some))
    if _smallest_step(some[:FIRST_VALUES]) < least:
        return 0.0
    step = _smallest_step(some)
    return step if np.isfinite(step) and step >= least else 0.0


def first_of_each(values: Floats) -> Indices | None:
    """Return the first sample of each value, if a sensor gives each of them several times."""
    first = np.flatnonzero(np.diff(values, prepend=np.nan) != 0.0)
    lasts = np.diff(first)[1:]
    if len(lasts) < ENOUGH_VALUES or lasts.min() < 2 or np.ptp(lasts) > JITTER:
        return None
    changes = np.abs(np.diff(values[first]))
    return first if changes.max() > ONE_STEP * changes.min() else None


def _smallest_step(values: Floats) -> float:
    """Return the smallest step between different values; infinite if all are the same."""
    return float(np.diff(np.unique(values)).min(initial=np.inf))


def fall_by_rounding(values: Floats) -> float:
    """Return the fall that the steps of a converter make of an even change; 0 without steps."""
    return ROUNDED * resolution(values)


def rounding_of_mean(values: Floats, width: float) -> float:
    """Return the standard error by rounding of a mean over which a signal moves by `width`.

    A ramp through many steps reduces it, and so does noise of their size.
    """
    step = resolution(values)
    return rounding_error(values, step) * (step / max(step, width)) if step else 0.0


def rounding_line(values: Floats) -> float:
    """Return the amplitude of the strongest line that rounding makes of a ramp through steps."""
    step = resolution(values)
    return step / np.pi * dither_remainder(values, step) if step else 0.0
