"""The output arrays of a run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stiction.errors import DescriptionError, Fault
from stiction.machine import shortage

STICK = 80.0  # bytes of memory per stick interval, for all tables and intermediate arrays


@dataclass
class Output:
    """Samples at `times` (ascending, s), stick intervals, and the progress of both.

    `samples` (n, columns), `sticks` (m, 2) in s, `filled` samples, `used` steps.
    """

    times: np.ndarray
    samples: np.ndarray
    sticks: np.ndarray
    filled: int = 0
    used: int = 0

    def make_room(self, sticks: int) -> None:
        """Double the room for stick intervals if `sticks` fill it.

        Raises
        ------
        DescriptionError
            If they do not fit into memory.
        """
        if sticks < len(self.sticks):
            return
        if short := shortage(STICK * 2.0 * sticks):
            message = (
                f"more than {sticks} sticks, of which each is recorded; room for twice as many"
            )
            raise DescriptionError([Fault("run.duration", f"{message} {short}; shorten it")])
        self.sticks = np.concatenate([self.sticks, np.empty_like(self.sticks)])
