"""A stretch of a drive or of a normal load that follows a recorded table."""

from __future__ import annotations

from typing import Any, NamedTuple

from stiction.drive.recorded.spline import (
    Recording,
    recording_at,
    recording_change,
    recording_curve,
    recording_sum,
)
from stiction.drive.signal import Signal, signal_at, signal_change, signal_curve, signal_sum


class RecordedCourse(NamedTuple):
    """A stretch of a drive: its recorded velocity along X, and a wave across it."""

    along: Recording
    across: Signal

    def travel(drive, t: Any, dt: Any) -> tuple[Any, Any]:
        """Return the displacement from time `t` to `t + dt`, in m."""
        return recording_sum(drive.along, t, dt), signal_sum(drive.across, t, dt)

    def rate(drive, t: Any) -> tuple[Any, Any]:
        """Return the velocity at time `t`, in m/s."""
        return recording_at(drive.along, t), signal_at(drive.across, t)

    def rate_change(drive, t: Any) -> tuple[Any, Any]:
        """Return the acceleration at time `t`, in m/s^2."""
        return recording_change(drive.along, t), signal_change(drive.across, t)

    def rate_curve(drive, t: Any) -> tuple[Any, Any]:
        """Return the rate of change of the acceleration at time `t`, in m/s^3."""
        return recording_curve(drive.along, t), signal_curve(drive.across, t)

    def steady(drive) -> bool:
        """Return whether the velocity is constant; the compiler knows the answer."""
        return False


class RecordedLoading(NamedTuple):
    """A stretch of a recorded normal load."""

    force: Recording

    def at(load, t: Any) -> Any:
        """Return the normal load at time `t`, in N."""
        return recording_at(load.force, t)

    def drift(load, t: Any) -> Any:
        """Return the rate of change of the load, in N/s."""
        return recording_change(load.force, t)

    def constant(load) -> bool:
        """Return whether the load is constant; the compiler knows the answer."""
        return False
