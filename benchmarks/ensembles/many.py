"""The runs of an ensemble, and how to spread them over threads."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy as np
from numpy.typing import NDArray

PHI = np.radians(np.geomspace(0.5, 10.0, 64))
CORES = os.cpu_count() or 1


def in_threads(solve: Callable[..., NDArray[np.float64]]) -> Callable[..., NDArray[np.float64]]:
    """Return what solves every misalignment with a function for one, on all cores.

    The result has shape (runs, times, 2).
    """

    def solve_all(times: NDArray[np.float64], **settings: float) -> NDArray[np.float64]:
        one = partial(solve, times, **settings)
        with ThreadPoolExecutor(CORES) as threads:
            return np.array(list(threads.map(lambda phi: one(phi=phi), PHI)))

    return solve_all
