"""Signals that are cut off at the end of a sensor's range."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.arrays import Floats, Indices

# Times as many samples at the largest value as at any other, in a row, and at least so many; or in
# all, of which two are in a row. Of a sine in steps, the outer one has 2.4 times as many at most
FLAT = 4
TIMES = 3  # that a signal stays at its least value: at rest it does so once


class FlatEnd(NamedTuple):
    """An end of a signal's range at which it stays.

    By its name, "largest" or "least" in magnitude, with its value, in the unit of the signal, the
    most samples in a row there, and the noise within which they are there.
    """

    name: str
    value: float
    longest: int
    within: float = 0.0

    def mask(self, values: Floats) -> NDArray[np.bool_]:
        """Return which values are at this end."""
        return np.abs(values - self.value) <= self.within


def flat_ends(values: Floats) -> list[FlatEnd]:
    """Return the ends of its range at which a signal stays longer or more often than elsewhere."""
    way = 1.0 if values.max(initial=0.0) >= -values.min(initial=0.0) else -1.0
    turned = way * values
    if not len(turned):
        return []
    begins = np.flatnonzero(np.diff(turned, prepend=turned[0] - 1.0))
    lasts, each = np.diff(begins, append=len(turned)), turned[begins]
    top, bottom = each == turned.max(), each == turned.min()
    if (top | bottom).all():
        return []
    others = ~top & ~bottom
    flat = lasts >= max(FLAT, FLAT * int(lasts[others].max()) + 1)
    ends = (("largest", top, 1), ("least", bottom, TIMES))
    return [
        FlatEnd(name, way * float(each[end][0]), int(lasts[end].max()))
        for name, end, least in ends
        if np.count_nonzero(flat & end) >= least
        or (
            np.count_nonzero(end) >= TIMES
            and lasts[end].max() > 1
            and lasts[end].sum() > FLAT * _most(each[others], lasts[others])
        )
    ]


def _most(values: Floats, lasts: Indices) -> int:
    """Return the number of samples of the most common value; each value `lasts` some samples."""
    _, kind = np.unique(values, return_inverse=True)
    return int(np.bincount(kind, lasts).max())
