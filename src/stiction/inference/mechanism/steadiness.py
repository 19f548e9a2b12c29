"""Whether the cycles of a record stay the same: what is simulated has no trend."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from stiction.arrays import Floats
from stiction.inference.features import Cycles


def trend(records: Iterable[tuple[Floats, Cycles]]) -> float:
    """Return how probable as clear a trend is in records whose cycles have none.

    Of peaks or drops with the number of their cycle, by Kendall's rank correlation (M. G. Kendall,
    Biometrika 30, 81 (1938)); the smallest of all probabilities, times their number.

    Parameters
    ----------
    records : iterable of (ndarray, Cycles)
        The force of each record, and its cycles.

    Examples
    --------
    >>> saw = np.concatenate([np.r_[0.0:1.0:9j, 0.5] * 1.05**n for n in range(12)])
    >>> from stiction.inference.features import find_cycles
    >>> trend([(saw, find_cycles(saw))]) < 1e-3
    True
    """
    from scipy.stats import kendalltau

    found = []
    for force, cycles in records:
        peaks = force[cycles.peak]
        for values in (peaks, peaks - force[cycles.after]):
            its = float(kendalltau(np.arange(len(values)), values).pvalue)
            found.append(its if np.isfinite(its) else 1.0)  # all the same
    return min(1.0, min(found, default=1.0) * len(found))
