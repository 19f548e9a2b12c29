"""A case with a known solution, and functions for several of them."""

from __future__ import annotations

from collections.abc import Callable
from math import log
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.presets import Number

Floats = NDArray[np.float64]


class Case(NamedTuple):
    """A case with a known solution.

    Attributes
    ----------
    name : str
        What moves.
    numbers : callable
        Takes the relative tolerance of the runs; returns what is known of the solution beside what
        is computed, in the same order at any tolerance.
    rtol : float
        A tolerance at which every number agrees: that to which the tests hold it.
    """

    name: str
    numbers: Callable[[float], list[Number]]
    rtol: float = 1e-10


def growth(values: Floats, rate: float, order: int) -> float:
    """Return the growth rate (1/s) of what obeys a linear equation of some order.

    Evenly spaced samples of its solution, `rate` per second, obey a recurrence of so many terms,
    whose roots are exp(eigenvalue/rate).
    """
    rows = np.lib.stride_tricks.sliding_window_view(values[:-1], order)
    terms = np.linalg.lstsq(rows, values[order:])[0]
    return rate * log(np.abs(np.roots([1.0, *-terms[::-1]])).max())
