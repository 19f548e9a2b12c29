"""What a study keeps of each run: numbers with their units, one line each."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from stiction.study.observed import Observed


class Measure(NamedTuple):
    """A number that a run comes to.

    Parameters
    ----------
    unit, long_name : str
        CF attributes.
    of : callable
        From what was observed to the number; NaN where there is none.
    """

    unit: str
    long_name: str
    of: Callable[[Observed], float]


def _first_slip(seen: Observed) -> int:
    """Return the sample at which the mass is first faster than the drive; the last if never."""
    drive = np.abs(seen.description.slider.motion.rate(seen.time)[0])
    faster = seen.velocity > drive
    found = int(np.argmax(faster))
    return found if faster[found] else len(faster) - 1


MEASURES: dict[str, Measure] = {
    "peak_force": Measure(
        "N", "largest spring force along x, k_x u_x", lambda seen: float(np.max(seen.force))
    ),
    "final_force": Measure(
        "N", "spring force along x at the end", lambda seen: float(seen.force[-1])
    ),
    "peak_velocity": Measure(
        "m/s",
        "largest velocity of the mass along the drive",
        lambda seen: float(np.max(seen.velocity)),
    ),
    "first_slip_time": Measure(
        "s",
        "when the mass first moves faster than the drive",
        lambda seen: float(seen.time[_first_slip(seen)]),
    ),
    "creep_distance": Measure(
        "m",
        "distance that the mass creeps along the drive before its first slip",
        lambda seen: float(seen.position[_first_slip(seen)] - seen.position[0]),
    ),
    "time_stuck": Measure(
        "s", "sum of all stick intervals", lambda seen: seen.solution.counts.stuck
    ),
    "stick_count": Measure(
        "1", "number of stick intervals", lambda seen: float(seen.solution.counts.sticks)
    ),
    "steps": Measure(
        "1", "slip steps of the solver", lambda seen: float(seen.solution.counts.steps)
    ),
}
DEFAULT = ("peak_force", "final_force", "creep_distance", "time_stuck")
