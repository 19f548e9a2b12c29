"""The load cell of a slider: its axis, and how its force rises while the mass rests."""

from __future__ import annotations

from typing import NamedTuple

from stiction.drive.program import nominal_velocity
from stiction.system.slider import Slider
from stiction.system.tensors import ROUND

# of a load cell that measures nothing of a force
ACROSS = (
    "stands across the force of the springs and measures nothing of it; cell_angle = '0 deg' in "
    "[slider] lays it along the drive"
)


class CellAxis(NamedTuple):
    """The axis (x, y) of a load cell in the frame of the springs.

    `share` is the cosine of its angle to the drive, `velocity` that of the drive along it, m/s.
    `way` is -1 where the drive goes against it: forces and positions are turned round.
    """

    x: float
    y: float
    share: float
    velocity: float
    way: float


def cell_axis(slider: Slider) -> CellAxis:
    """Return the axis of a slider's load cell: the spring x, or the direction of `cell_angle`."""
    x, y = (1.0, 0.0) if slider.cell_angle is None else slider.cell
    share = float(slider.along_drive(x, y))
    share = 0.0 if abs(share) < ROUND else share  # at a right angle
    along = nominal_velocity(slider.motion) * share
    return CellAxis(x, y, share, along, -1.0 if along < 0.0 else 1.0)


def stiffness_of_cell(slider: Slider, k_y: float) -> float | None:
    """Return by how much the force along a load cell rises over the drive's way along it, N/m.

    That is while the mass rests, with a stiffness `k_y` across; with 0 while the mass follows the
    drive across. None where loading unloads the cell.
    """
    cell = cell_axis(slider)
    if not cell.share:
        return None
    stiffness = slider.along_drive(cell.x * slider.k_x, cell.y * k_y) / cell.share
    return stiffness if stiffness > 0.0 else None
