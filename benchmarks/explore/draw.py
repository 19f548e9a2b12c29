"""Random numbers by seed and number alone: the same on every machine, whatever else is loaded."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, log
from typing import TypeVar

import numpy as np

T = TypeVar("T")


class Draw:
    """A stream of random numbers that a seed and a number stand for.

    Parameters
    ----------
    seed, number : int
        What tells one stream from all others.
    """

    def __init__(self, seed: int, number: int):
        """Begin the stream."""
        self.random = np.random.Generator(np.random.Philox([seed, number])).random

    def between(self, low: float, high: float) -> float:
        """Return a number between two, evenly."""
        return low + (high - low) * float(self.random())

    def decades(self, low: float, high: float) -> float:
        """Return a number between two, evenly in its logarithm."""
        return exp(self.between(log(low), log(high)))

    def chance(self, share: float) -> bool:
        """Return True in a share of all draws."""
        return bool(self.random() < share)

    def among(self, choices: Sequence[T]) -> T:
        """Return one of several, all as likely."""
        return choices[int(self.random() * len(choices))]
