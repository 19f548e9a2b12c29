"""The drawing of a misalignment: exaggerated, with a note, if too small to be seen."""

from __future__ import annotations

from collections.abc import Callable
from math import copysign, cos, degrees, pi, radians, sin

import numpy as np
from numpy.typing import ArrayLike

from stiction.arrays import Floats

Placement = Callable[[ArrayLike], Floats]

LEAST, EXAGGERATED = radians(20), radians(24)  # a smaller misalignment is drawn like this
STEEP = radians(60)  # one within LEAST of a right angle, like this


def drawn_misalignment(phi: float) -> float:
    """Return the angle at which a misalignment `phi` is drawn (both rad).

    Angles too close to 0 or to a right angle to be seen are exaggerated; 0 and 90 degrees
    themselves are drawn as they are.
    """
    size = abs(phi)
    if min(size, abs(pi / 2 - size)) < 1e-9:
        return phi
    if size < LEAST:
        return copysign(EXAGGERATED, phi)
    return copysign(STEEP, phi) if size > pi / 2 - LEAST else phi


def drawn_slip_angle(drawn: float) -> float:
    """Return the angle theta (rad) of slip and friction to x in the drawing.

    It lies between the misalignment and a right angle. Without misalignment the slip has no
    reason to leave X: theta = phi.
    """
    return drawn if drawn == 0 else (drawn + copysign(pi / 2, drawn)) / 2


def misalignment_note(phi: float) -> str:
    """Return the misalignment in words, with a note if it is not to scale."""
    drawn, size = drawn_misalignment(phi), f"{degrees(phi):.4g}°".replace("-", "−")
    if abs(drawn - phi) < 1e-9:
        return rf"$\varphi$ = {size}"
    return rf"$\varphi$ = {size}, " + f"drawn at {degrees(drawn):.0f}°".replace("-", "−")


def placement(drawn: float) -> Placement:
    """Return the map from points in the axes of the spring to the drawing.

    For a negative misalignment the drawing is that of the positive one, mirrored about X.

    Parameters
    ----------
    drawn : float
        Misalignment as drawn, rad.
    """
    phi, side = abs(drawn), copysign(1.0, drawn)
    turn = np.array([[cos(phi), -sin(phi)], [sin(phi), cos(phi)]])

    def lab(points: ArrayLike) -> Floats:
        placed: Floats = (np.asarray(points, dtype=np.float64) @ turn) * (1.0, side)
        return placed

    return lab
