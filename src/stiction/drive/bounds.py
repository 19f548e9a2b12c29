"""Bounds of drive and load in a stretch, and the time at which a load vanishes."""

from __future__ import annotations

from math import inf
from typing import Any, NamedTuple

import numpy as np

from stiction.drive.recorded.spline import Recording
from stiction.drive.signal import Signal


def drive_bounds(drive: Any, start: float, end: float) -> tuple[tuple[Any, Any], ...]:
    """Return bounds (X, Y) of the drive's velocity and of its first three derivatives."""
    if drive.steady():
        X, Y = drive.rate(start)
        return (abs(X), abs(Y)), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0)
    along, across = (s.bounds_between(start, end) for s in drive)
    return tuple(zip(along, across, strict=True))


def load_bounds(load: Any, start: float, end: float) -> tuple[Any, Any, Any]:
    """Return bounds of the normal load (N) and of its first two derivatives."""
    if load.constant():
        return load.at(start), 0.0, 0.0
    force, change, curve, _ = load.force.bounds_between(start, end)
    return force, change, curve


class RowBounds(NamedTuple):
    """Bounds between the rows of tables of a drive and a load, as `drive_bounds` gives them.

    Parameters
    ----------
    rows : ndarray
        (n + 1,), s.
    drive, load : tuple
        Of floats, or of arrays (n,).
    """

    rows: np.ndarray
    drive: tuple[tuple[Any, Any], ...]
    load: tuple[Any, Any, Any]


def row_bounds(drive: Any, load: Any, start: float, end: float) -> RowBounds:
    """Return bounds between the rows of the tables of a drive and a load."""
    rows = np.unique(np.concatenate([[start, end], drive.along.rows, load.force.rows]))
    rows = rows[(rows >= start) & (rows <= end)]
    along, across = drive.along.bounds_at(rows), drive.across.bounds_between(start, end)
    of_drive = tuple(zip(along, across, strict=True))
    return RowBounds(rows, of_drive, load.force.bounds_at(rows)[:3])


def vanishes(load: Any, start: float, end: float) -> float:
    """Return the time at which the normal load vanishes; infinity if not before `end` (s)."""
    if load.constant():
        return inf
    zeros = (_zero(load.force, *each) for each in load.force.may_vanish(start, end))
    return next((zero for zero in zeros if zero < inf), inf)


def _zero(force: Signal | Recording, start: float, end: float) -> float:
    """Return the first zero of a force; infinity if there is none before `end` (s).

    As in a stick, steps are as long as the bounds of the load's derivatives allow.
    """
    curve = force.bounds_between(start, end)[2]
    t = start
    while t < end:
        now, change = force.value_at(t), force.change_at(t)
        if now <= 0.0:
            return t
        # now + change dt - curve dt^2/2 > 0 before this
        root = (change * change + 2.0 * curve * now) ** 0.5
        dt = 2.0 * now / (root - change) if root > change else inf
        following = t + dt
        if following == t:
            return t
        t = following
    return inf
