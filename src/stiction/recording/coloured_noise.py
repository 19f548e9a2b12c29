"""Noise that lasts for several samples, as rows of samples of the same course show it."""

from __future__ import annotations

from importlib import import_module
from math import exp, sqrt
from typing import Any, NamedTuple

import numpy as np

from stiction.arrays import Floats

DEGREE = 5  # of the polynomial that is taken from each row: a course that differs from row to row
FEWEST_ROWS, FEWEST_SAMPLES = 5, 30
SHARES = (0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.97, 1.0)  # of the variance, tried
# Times the usual variance of a row, or that of another third of all rows: more is another course,
# or motion. Thirds of noise that lasts for an eighth of a row differ by a factor of 1.7 at most.
MUCH = 3.0
FINER = 2.0**0.5  # ratio of the times tried, from one sample to a quarter of a row
# twice the logarithm of the likelihood's ratio to white noise: below 4 in 95 % of records of white
# noise, 140 and more in 95 % of those with as much noise that lasts 1.25 or 12.5 samples
CLEAR = 20.0
MOST_PLACES = 16  # in a block, at which its readings count: more change no mean


class ColouredNoise(NamedTuple):
    """White noise, and noise whose correlation falls by a factor of e within a time.

    Parameters
    ----------
    white, deviation : float
        Standard deviation of either.
    time : float
        In samples.
    """

    white: float
    deviation: float
    time: float


def coloured_noise(rows: Floats, block: int = 1) -> ColouredNoise | None:
    """Estimate the noise of rows of the same course; None where it is white.

    By the largest likelihood of what is left of each row without its polynomial and without what
    all rows have in common.

    Parameters
    ----------
    rows : ndarray
        (c, n), equally spaced samples.
    block : int
        Readings of which each sample is the mean. The noise that lasts is that of a reading.

    Examples
    --------
    >>> random = np.random.default_rng(1)
    >>> course = np.sin(np.linspace(0.0, 3.0, 100))
    >>> white = 0.01 * random.standard_normal((20, 100))
    >>> coloured_noise(course + white) is None
    True
    >>> lasting = np.array([draw_lasting(100, 0.02, 5.0, random) for _ in range(20)])
    >>> np.round(coloured_noise(course + white + lasting), 2).tolist()
    [0.01, 0.02, 5.66]
    """
    count, size = rows.shape
    if count < FEWEST_ROWS or size < FEWEST_SAMPLES:
        return None
    powers = np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, size), DEGREE)
    beside = np.linalg.qr(powers, mode="complete")[0][:, DEGREE + 1 :]
    left = usual(rows @ beside)
    count = len(left)
    left = left - left.mean(axis=0)
    freedom, covariance = (count - 1) * left.shape[1], left.T @ left
    variance = float(np.trace(covariance)) / freedom
    if variance <= 0.0 or not is_steady(left @ beside.T):
        return None
    apart = np.abs(np.subtract.outer(np.arange(size), np.arange(size)))
    best, found = -freedom * np.log(variance) + CLEAR, None
    time = 1.0
    while time <= size / 4.0:
        own, axes = np.linalg.eigh(beside.T @ correlation(size, time, block)[apart] @ beside)
        seen = np.einsum("ji,jk,ki->i", axes, covariance, axes)
        for share in SHARES:
            expected = share * own + 1.0 - share
            variance = float(np.sum(seen / expected)) / freedom
            likelihood = -freedom * np.log(variance) - (count - 1) * float(np.log(expected).sum())
            if likelihood > best:
                white, deviation = sqrt((1.0 - share) * variance), sqrt(share * variance)
                best, found = likelihood, ColouredNoise(white, deviation, time)
        time *= FINER
    return found


def correlation(size: int, time: float, block: int) -> Floats:
    """Return the covariance of means of readings that are 0, 1, ... (size) means apart.

    Of readings of variance 1, whose correlation falls by a factor of e within a time, in means.

    >>> correlation(3, 2.0, 1).round(3), correlation(3, 2.0, 4).round(3)
    (array([1.   , 0.607, 0.368]), array([0.862, 0.618, 0.375]))
    """
    places = np.arange(min(block, MOST_PLACES))
    between = np.subtract.outer(places, places).ravel() / len(places)
    return np.asarray(np.exp(-np.abs(np.add.outer(np.arange(size), between)) / time).mean(axis=1))


def is_steady(rows: Floats) -> bool:
    """Return whether rows vary as much in each third: motion does not, as it swings or creeps."""
    squares = [np.mean(part**2) for part in np.array_split(rows, 3, axis=1)]
    return bool(max(squares) <= MUCH * min(squares))


def usual(rows: Floats) -> Floats:
    """Return the rows that do not deviate much more than half of them do."""
    squares = np.mean((rows - np.median(rows, axis=0)) ** 2, axis=1)
    return np.asarray(rows[squares <= MUCH * np.median(squares)])


def draw_lasting(size: int, deviation: float, time: float, random: np.random.Generator) -> Floats:
    """Draw noise whose correlation falls by a factor of e within a time, in samples."""
    signal: Any = import_module("scipy.signal")  # slow to import
    kept = exp(-1.0 / time)
    own = random.standard_normal(size)
    own[1:] *= sqrt(1.0 - kept * kept)
    return np.asarray(deviation * signal.lfilter([1.0], [1.0, -kept], own))
