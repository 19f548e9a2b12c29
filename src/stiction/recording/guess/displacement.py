"""Displacements that start again at the end of a sensor's range."""

from __future__ import annotations

import numpy as np

from stiction.arrays import Floats
from stiction.recording.guess.clock import ONE_MISSING

ALIKE_JUMPS = 0.1  # relative difference of jumps that are one wrap
WHOLE = 0.8  # of the range of values: smaller jumps are motion
QUIET = 0.25  # of the jump: other steps are smaller


def unwrap(values: Floats, time: Floats, period: float | None) -> tuple[Floats, float, int]:
    """Return values made continuous, the length after which they start again, and how often.

    A wrap is a jump by the whole range of values from one sample to the next, without a gap in
    time. Without a `period` it is the mean of the jumps and the steps beside them.

    Parameters
    ----------
    values, time : ndarray
        (n,), m and s, none missing.
    period : float or None
        m; 0 for a displacement that does not wrap.
    """
    if period == 0.0 or len(values) < 8:
        return values, 0.0, 0
    steps = np.diff(values)
    if period is not None:
        turns = np.rint(steps / period)
        count = int(np.count_nonzero(turns))
        return values - np.concatenate([[0.0], np.cumsum(turns)]) * period, period, count
    span = float(np.ptp(values))
    at = np.flatnonzero(np.abs(steps) > WHOLE * span) if span > 0.0 else np.zeros(0, np.intp)
    rest = np.delete(np.abs(steps), at)
    intervals = np.diff(time)
    gap = bool(len(at)) and float(intervals[at].max()) > ONE_MISSING * float(np.median(intervals))
    if not len(at) or gap or rest.max(initial=0.0) > QUIET * span:
        return values, 0.0, 0
    sizes = np.abs(steps[at])
    if np.ptp(sizes) > ALIKE_JUMPS * span or abs(np.sign(steps[at]).sum()) != len(at):
        return values, 0.0, 0
    # a jump is the period less the step that the motion takes meanwhile
    inner = np.clip(at, 1, len(steps) - 2)
    beside = 0.5 * (steps[inner - 1] + steps[inner + 1])
    length = float(np.mean(np.abs(steps[at] - beside)))
    turns = np.zeros(len(values))
    turns[at + 1] = np.sign(steps[at])
    return values - np.cumsum(turns) * length, length, len(at)
