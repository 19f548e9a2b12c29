"""What a run fills in on the way."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass
class Output:
    """Samples at `times` (ascending, s), stick intervals, and how far they and the run are.

    `samples` (n, columns), `sticks` (m, 2) in s, `filled` samples, `used` steps.
    """

    times: np.ndarray
    samples: np.ndarray
    sticks: np.ndarray
    filled: int = 0
    used: int = 0

    def make_room(self, sticks: int) -> None:
        """Double the room for stick intervals if `sticks` fill it."""
        if sticks == len(self.sticks):
            self.sticks = np.concatenate([self.sticks, np.empty_like(self.sticks)])
