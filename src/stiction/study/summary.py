"""How the runs of a study ended, in words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from stiction.study.plan import Study
from stiction.study.store import COMPLETED, ENDS, PENDING, Store


class Failure(NamedTuple):
    """A run that failed: its coordinates, each with its unit, how it ended, and why."""

    at: Mapping[str, tuple[float, str]]
    end: str
    message: str

    def __str__(self) -> str:
        """Name the run by its parameters."""
        where = ", ".join(
            f"{path} = {value:.6g} {its}".rstrip() for path, (value, its) in self.at.items()
        )
        return f"{where}: {self.message}"


class Summary(NamedTuple):
    """How the runs of a study ended.

    Parameters
    ----------
    runs, pending : int
        Runs in all, and those not done.
    failed : mapping of str to int
        How many ended in each other way than as intended.
    first : Failure or None
        The first of them.
    """

    runs: int
    pending: int
    failed: Mapping[str, int]
    first: Failure | None


def summary(study: Study, store: Store) -> Summary:
    """Count how the runs in a store ended."""
    status = store.status()
    codes, counts = np.unique(status, return_counts=True)
    found = dict(zip(codes.tolist(), counts.tolist(), strict=True))
    pending = found.pop(PENDING, 0)
    found.pop(COMPLETED, None)
    failed = {ENDS[code]: count for code, count in found.items()}
    first = None
    if failed:
        flat = int(np.argmax(status.ravel() > COMPLETED))
        index = tuple(int(i) for i in np.unravel_index(flat, status.shape))
        at = dict(zip(store.layout.dims, index, strict=True))
        where = {p: (float(c.values[at[c.dim]]), c.unit) for p, c in study.coordinates.items()}
        first = Failure(where, ENDS[status[index]], store.message(index))
    return Summary(status.size, pending, failed, first)
