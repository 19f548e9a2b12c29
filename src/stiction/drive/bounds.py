"""Bounds of drive and load in a stretch, and the time at which a load vanishes."""

from __future__ import annotations

from math import inf
from typing import Any, NamedTuple

import numpy as np

from stiction.drive.recorded.spline import Recording, place, recording_at, recording_change
from stiction.drive.recorded.stretch import RecordedCourse, RecordedLoading
from stiction.drive.signal import (
    Course,
    Loading,
    Signal,
    signal_at,
    signal_bounds,
    signal_change,
)

Bounds = tuple[Any, Any, Any, Any]  # of floats, or of arrays over the rows of tables


def drive_bounds(drive: Any, start: float, end: float) -> tuple[tuple[Any, Any], ...]:
    """Return bounds (X, Y) of the drive's velocity and of its first three derivatives."""
    if not isinstance(drive, Course | RecordedCourse):
        X, Y = drive.rate(start)
        return (abs(X), abs(Y)), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0)
    along, across = (bounds_of(s, start, end) for s in drive)
    return tuple(zip(along, across, strict=True))


def load_bounds(load: Any, start: float, end: float) -> tuple[Any, Any, Any]:
    """Return bounds of the normal load (N) and of its first two derivatives."""
    if not isinstance(load, Loading | RecordedLoading):
        return load.at(start), 0.0, 0.0
    return bounds_of(load.force, start, end)[:3]


def bounds_of(s: Signal | Recording, start: float, end: float) -> Bounds:
    """Return bounds of the magnitudes of the value and its first three derivatives."""
    if not isinstance(s, Recording):
        return signal_bounds(s, start, end)
    most = between(s, start, end).max(axis=0)
    wave = signal_bounds(s.wave, start, end)
    return tuple(float(a) + b for a, b in zip(most, wave, strict=True))  # type: ignore[return-value]


def between(s: Recording, start: float, end: float) -> np.ndarray:
    """Return bounds (n, 4) of the value and its derivatives in the pieces from start to end."""
    found = s.bounds[int(place(s, start)) : int(place(s, end)) + 1]
    return np.column_stack([np.abs(found[:, :2]).max(axis=1), found[:, 2:]])


class RowBounds(NamedTuple):
    """Bounds between the rows of tables of a drive and a load, as of `drive_bounds`.

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


def row_bounds(drive: RecordedCourse, load: RecordedLoading, start: float, end: float) -> RowBounds:
    """Return bounds between the rows of the tables of a drive and a load."""
    rows = np.unique(np.concatenate([[start, end], drive.along.rows, load.force.rows]))
    rows = rows[(rows >= start) & (rows <= end)]
    across = signal_bounds(drive.across, start, end)
    along = _at_rows(drive.along, rows)
    return RowBounds(rows, tuple(zip(along, across, strict=True)), _at_rows(load.force, rows)[:3])


def _at_rows(s: Recording, rows: np.ndarray) -> Bounds:
    """Return bounds of a recording between rows, of which its own are some."""
    found = s.bounds[place(s, rows[:-1])]
    wave = signal_bounds(s.wave, float(rows[0]), float(rows[-1]))
    value = np.abs(found[:, :2]).max(axis=1) + wave[0]
    return value, found[:, 2] + wave[1], found[:, 3] + wave[2], found[:, 4] + wave[3]


def fastest(s: Any) -> float:
    """Return the largest angular frequency in a signal or recording, rad/s; 0 without any.

    That of a recording is its largest curvature over its largest slope, as of a harmonic.
    """
    if isinstance(s, Recording):
        _, _, change, curve, _ = np.abs(s.bounds).max(axis=0)
        return max(fastest(s.wave), float(curve / change) if change > 0.0 else 0.0)
    waves = ((s.amplitude, s.omega), (s.amplitude_2, s.omega_2))
    return max((abs(omega) for amplitude, omega in waves if amplitude != 0.0), default=0.0)


def vanishes(load: Any, start: float, end: float) -> float:
    """Return the time at which the normal load vanishes; infinity if not before `end` (s)."""
    if isinstance(load, Loading):
        return _zero(load.force, start, end)
    if not isinstance(load, RecordedLoading):
        return inf
    force = load.force
    least = force.bounds[:, 0] - signal_bounds(force.wave, start, end)[0]
    first, last = int(place(force, start)), int(place(force, end))
    for i in (np.flatnonzero(least[first : last + 1] <= 0.0) + first).tolist():
        begin, until = max(start, float(force.rows[i])), min(end, float(force.rows[i + 1]))
        found = _zero(force, begin, until)
        if found < inf:
            return found
    return inf


def _zero(force: Any, start: float, end: float) -> float:
    """Return the first zero of a force; infinity if there is none before `end` (s).

    As in a stick, steps are as long as the bounds of the load's derivatives allow.
    """
    recorded = isinstance(force, Recording)
    value, slope = (recording_at, recording_change) if recorded else (signal_at, signal_change)
    curve = bounds_of(force, start, end)[2]
    t = start
    while t < end:
        now, change = value(force, t), slope(force, t)
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
