"""The load cell of a slider: its axis, and how its force rises while the mass rests."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from stiction.arrays import Floats

if TYPE_CHECKING:
    from stiction.system.slider import Slider

# of a load cell that measures nothing of a force
ACROSS = (
    "stands across the force of the springs and measures nothing of it; cell_angle = '0 deg' in "
    "[slider] lays it along the drive"
)


class CellAxis(NamedTuple):
    """The axis (x, y) of a load cell in the frame of the springs.

    `share` is the cosine of its angle to the drive, `velocity` that of the drive along it, m/s.
    `way` is -1 where the drive goes against it, or, if it goes to and fro, where the cell points
    against X: forces and positions are turned round.
    """

    x: float
    y: float
    share: float
    velocity: float
    way: float

    @property
    def ahead(self) -> float:
        """The sign of the force along the cell that pulls along X: -1 where it points against X."""
        return -1.0 if self.share < 0.0 else 1.0

    def along(self, x: Any, y: Any) -> Any:
        """Return the component along the cell of a vector with these along the axes (x, y)."""
        return self.x * x + self.y * y

    def across(self, x: Any, y: Any) -> Any:
        """Return the component across the cell, a quarter turn ahead, of such a vector."""
        return self.x * y - self.y * x


def travel_along_cell(slider: Slider, time: Floats) -> Floats:
    """Return how far the drive has moved along the load cell since the first time, (n,), m.

    That is with its motion across X, and positive where the drive goes on its one velocity.
    """
    cell, (c, s) = slider.load_cell, slider.direction
    X, Y = slider.motion.travel(time[0], time - time[0])
    return np.asarray(cell.way * (cell.share * X + (cell.y * c - cell.x * s) * Y))


def stiffness_of_cell(slider: Slider, k_y: float) -> float | None:
    """Return by how much the force along a load cell rises over the drive's way along it, N/m.

    That is while the mass rests, with a stiffness `k_y` across; with 0 while the mass follows the
    drive across. None where loading unloads the cell.
    """
    cell = slider.load_cell
    if not cell.share:
        return None
    stiffness = slider.along_drive(cell.x * slider.k_x, cell.y * k_y) / cell.share
    return stiffness if stiffness > 0.0 else None
