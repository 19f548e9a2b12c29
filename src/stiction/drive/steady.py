"""Smooth stretches of a drive and of a normal load, for the compiled solver.

Between the instants at which a program jumps or bends, the drive velocity and the normal load
are constant, signals, or the splines through recorded rows; the solver integrates one such stretch
after the other and never meets a jump.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from stiction.drive.recorded.spline import Recording
from stiction.drive.signal import Signal, change_at, curve_at, sum_over, value_at
from stiction.text.units import Force, Velocity
from stiction.text.validation import validate


@validate
class ConstantVelocity(NamedTuple):
    """A drive along X with a constant velocity, from t = 0 on.

    Parameters
    ----------
    velocity : float or str
        V, in m/s.

    Examples
    --------
    >>> import stiction as st
    >>> st.ConstantVelocity("1 mm/s").velocity
    0.001
    """

    velocity: Velocity

    def travel(drive, t: float, dt: Any) -> tuple[Any, Any]:
        """Return V dt along X."""
        return drive.velocity * dt, 0.0

    def rate(drive, t: Any) -> tuple[Any, Any]:
        """Return V along X."""
        return drive.velocity, 0.0

    def rate_change(drive, t: float) -> tuple[float, float]:
        """Return zero."""
        return 0.0, 0.0

    def rate_curve(drive, t: float) -> tuple[float, float]:
        """Return zero."""
        return 0.0, 0.0

    def steady(drive) -> bool:
        """Return True."""
        return True


@validate
class ConstantLoad(NamedTuple):
    """A constant normal load.

    Parameters
    ----------
    force : float or str
        W, in N.
    """

    force: Force

    def at(load, t: float) -> float:
        """Return W."""
        return load.force

    def drift(load, t: float) -> float:
        """Return zero."""
        return 0.0

    def constant(load) -> bool:
        """Return True."""
        return True


class VaryingVelocity(NamedTuple):
    """A velocity that varies within a stretch of the drive: along X and across it."""

    along: Signal | Recording
    across: Signal

    def travel(drive, t: Any, dt: Any) -> tuple[Any, Any]:
        """Return the displacement from time `t` to `t + dt`, in m."""
        return sum_over(drive.along, t, dt), sum_over(drive.across, t, dt)

    def rate(drive, t: Any) -> tuple[Any, Any]:
        """Return the velocity at time `t`, in m/s."""
        return value_at(drive.along, t), value_at(drive.across, t)

    def rate_change(drive, t: Any) -> tuple[Any, Any]:
        """Return the acceleration at time `t`, in m/s^2."""
        return change_at(drive.along, t), change_at(drive.across, t)

    def rate_curve(drive, t: Any) -> tuple[Any, Any]:
        """Return the rate of change of the acceleration at time `t`, in m/s^3."""
        return curve_at(drive.along, t), curve_at(drive.across, t)

    def steady(drive) -> bool:
        """Return whether the velocity is constant; the compiler knows the answer."""
        return False


class VaryingLoad(NamedTuple):
    """A normal load that varies within a stretch."""

    force: Signal | Recording

    def at(load, t: Any) -> Any:
        """Return the normal load at time `t`, in N."""
        return value_at(load.force, t)

    def drift(load, t: Any) -> Any:
        """Return the rate of change of the load, in N/s."""
        return change_at(load.force, t)

    def constant(load) -> bool:
        """Return whether the load is constant; the compiler knows the answer."""
        return False
