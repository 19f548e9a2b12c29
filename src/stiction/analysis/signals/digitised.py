"""Signals that are read in steps, as a converter of few bits gives them."""

from __future__ import annotations

import numpy as np

from stiction.arrays import Floats
from stiction.recording.noise import dither_remainder

MANY, FINE = 100_000, 1e-4  # samples examined for steps; finest step, over the signal's range


def resolution(values: Floats) -> float:
    """Return the smallest step between the values of a signal; 0 if it is nearly continuous."""
    some = values[:MANY]
    step = float(np.diff(np.unique(some)).min(initial=np.inf))
    return step if np.isfinite(step) and step >= FINE * float(np.ptp(some)) else 0.0


def rounding_line(values: Floats) -> float:
    """Return the amplitude of the strongest line that rounding makes of a ramp through steps."""
    step = resolution(values)
    return step / np.pi * dither_remainder(values, step) if step else 0.0
