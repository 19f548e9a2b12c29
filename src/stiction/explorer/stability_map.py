"""Growth of small disturbances of steady sliding over misalignment and drive velocity."""

from __future__ import annotations

from collections.abc import Iterator
from math import copysign, degrees, log10

import numpy as np

from stiction.errors import StictionError
from stiction.explorer.motion import Check, Reply
from stiction.linear_stability.linear import growth_rate
from stiction.system.description import Description
from stiction.system.parameter import change_unchecked

ANGLES = (0.1, 90.0)  # of misalignment, deg
DECADES = 3  # of the drive's velocity, to each side of its present one
LEVELS = ((12, 12), (24, 24), (48, 48))  # cells, from coarse to fine


def stability_map(description: Description, check: Check) -> Iterator[Reply]:
    """Yield maps of the growth rate (1/s), rows of velocity by columns of angle, each finer.

    Raises
    ------
    StictionError
        If there is no steady sliding.
    """
    slider = description.slider
    side = copysign(1.0, slider.phi)
    middle = round(log10(abs(slider.motion.velocity) or 1e-3))
    way = copysign(1.0, slider.motion.velocity)
    low, high = 10.0 ** (middle - DECADES), 10.0 ** (middle + DECADES)
    growth_rate(slider)  # or say why there is none
    for across, up in LEVELS:
        angles = np.radians(middles(*ANGLES, across)) * side
        speeds = middles(low, high, up) * way
        found = np.full((up, across), np.nan, np.float32)
        for row, speed in enumerate(speeds):
            driven = change_unchecked(slider, "drive.velocity", float(speed))
            for column, angle in enumerate(angles):
                check()
                found[row, column] = growth_at(driven, float(angle))
        head = {"angles": ANGLES, "speeds": (low, high), "own": degrees(abs(slider.phi))}
        yield head, {"growth": found}


def growth_at(slider: object, angle: float) -> float:
    """Return the growth rate at an angle (rad); NaN where there is no steady sliding."""
    try:
        return growth_rate(change_unchecked(slider, "phi", angle))  # type: ignore[arg-type]
    except (StictionError, ArithmeticError, ValueError):
        return float("nan")


def middles(low: float, high: float, count: int) -> np.ndarray:
    """Return the middles of cells of equal ratio."""
    edges = np.geomspace(low, high, count + 1)
    found: np.ndarray = np.sqrt(edges[1:] * edges[:-1])
    return found
