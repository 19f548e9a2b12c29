"""The rest before the first loading of a record, and the zero of the force that it shows.

A drive that starts after the recording leaves the spring as it was. Whether that was unloaded, the
record does not say: friction holds any force below its limit.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.analysis.signals.correlated_noise import ERRORS_997
from stiction.analysis.signals.robust import largest_magnitude
from stiction.arrays import Floats
from stiction.recording.noise import white_noise

FIRST_READINGS = 8, 400  # readings at the beginning: so many, or one in so many of all
NOISE = 5.0  # standard deviations: noise alone is as far from zero once in a million readings
SAME = 1e-9  # of the largest force: readings that differ by less are equal but for rounding
# Parts of the time up to half of the first loading, two of which are compared
PARTS_OF_LOADING = (8, 16, 32, 64)
FEWEST = 4  # samples in each of them
CONSTANT = 0.5  # of the average rate of that loading: a spring that is loaded already has all of it


class InitialRest(NamedTuple):
    """A rest with which a record begins."""

    reading: float  # of the force, N
    error: float  # of its mean in white noise, N


def first_reading(force: Floats) -> Floats:
    """Return the first readings of a force."""
    fewest, part = FIRST_READINGS
    return force[: max(fewest, len(force) // part)]


def first_level(force: Floats) -> tuple[float, float]:
    """Return the level of the first readings, or the first one if they rise, and their noise, N."""
    some = first_reading(force)
    noise = float(np.std(np.diff(some))) / 2.0**0.5
    within = max(NOISE * noise, SAME * largest_magnitude(force))  # of the middle, to either side
    level = float(np.ptp(some)) < 2.0 * within
    return float(np.median(some)) if level else float(some[0]), noise


def initial_rest(force: Floats, top: float) -> InitialRest | None:
    """Return the rest before a force is loaded for the first time up to a `top` (N), if any.

    In a force that rises from the first sample on, neighbouring parts differ by as much as half of
    its loading has it.
    """
    if len(force) < FIRST_READINGS[0]:
        return None
    rise = top - first_level(force)[0]
    half = int(np.argmax(force >= top - 0.5 * rise))
    noise = white_noise(force)
    for parts in PARTS_OF_LOADING:
        size = half // parts
        if size < FEWEST:
            break
        before, after = float(force[:size].mean()), float(force[size : 2 * size].mean())
        error = ERRORS_997 * noise * (2.0 / size) ** 0.5
        if abs(after - before) + error < CONSTANT * 0.5 * rise / parts:
            reading = float(np.median(force[: 2 * size]))
            return InitialRest(reading, noise / (2.0 * size) ** 0.5)
    return None
