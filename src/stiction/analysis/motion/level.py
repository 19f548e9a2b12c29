"""The course of a force that has no cycles: does it load, settle, or stay?"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

QUARTER = 8  # medians in each quarter of a record: few enough to be free of noise
PARTS = 4 * QUARTER


class Course(NamedTuple):
    """How the force of a record goes, from its medians over 32 equal parts.

    Parameters
    ----------
    change : float
        From the first part to the last, N.
    span : float
        Highest less lowest, N.
    late_span : float
        That of the last quarter, N.
    one_way : float
        Size of `change` over the sum of all ups and downs: 1 if it goes one way only.
    early_rate, late_rate : float
        Mean rates over the first and the last quarter, N/s.
    scatter : float
        Standard deviation of the samples about the medians, N.
    """

    change: float
    span: float
    late_span: float
    one_way: float
    early_rate: float
    late_rate: float
    scatter: float


def course(time: Floats, force: Floats) -> Course:
    """Return how the force goes; there are at least `PARTS` samples."""
    edges = np.linspace(0, len(time), PARTS + 1).astype(np.intp)[1:-1]
    parts = np.split(force, edges)
    f = np.array([np.median(part) for part in parts])
    t = np.array([part.mean() for part in np.split(time, edges)])
    scatter = np.sqrt(np.mean(np.concatenate([p - m for p, m in zip(parts, f, strict=True)]) ** 2))
    ups_and_downs = float(np.abs(np.diff(f)).sum())
    return Course(
        change=float(f[-1] - f[0]),
        span=float(np.ptp(f)),
        late_span=float(np.ptp(f[-QUARTER:])),
        one_way=abs(float(f[-1] - f[0])) / ups_and_downs if ups_and_downs else 0.0,
        early_rate=float((f[QUARTER] - f[0]) / (t[QUARTER] - t[0])),
        late_rate=float((f[-1] - f[-1 - QUARTER]) / (t[-1] - t[-1 - QUARTER])),
        scatter=float(scatter),
    )
