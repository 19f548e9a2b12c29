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

    def travel(self, t: float, dt: Any) -> tuple[Any, Any]:
        """Return V dt along X."""
        return self.velocity * dt, 0.0

    def rate(self, t: Any) -> tuple[Any, Any]:
        """Return V along X."""
        return self.velocity, 0.0

    def rate_change(self, t: float) -> tuple[float, float]:
        """Return zero."""
        return 0.0, 0.0

    def rate_curve(self, t: float) -> tuple[float, float]:
        """Return zero."""
        return 0.0, 0.0

    def steady(self) -> bool:
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

    def at(self, t: float) -> float:
        """Return W."""
        return self.force

    def drift(self, t: float) -> float:
        """Return zero."""
        return 0.0

    def constant(self) -> bool:
        """Return True."""
        return True


class VaryingVelocity(NamedTuple):
    """A velocity that varies within a stretch of the drive: along X and across it."""

    along: Signal | Recording
    across: Signal

    def travel(self, t: Any, dt: Any) -> tuple[Any, Any]:
        """Return the displacement from time `t` to `t + dt`, in m."""
        return sum_over(self.along, t, dt), sum_over(self.across, t, dt)

    def rate(self, t: Any) -> tuple[Any, Any]:
        """Return the velocity at time `t`, in m/s."""
        return value_at(self.along, t), value_at(self.across, t)

    def rate_change(self, t: Any) -> tuple[Any, Any]:
        """Return the acceleration at time `t`, in m/s^2."""
        return change_at(self.along, t), change_at(self.across, t)

    def rate_curve(self, t: Any) -> tuple[Any, Any]:
        """Return the rate of change of the acceleration at time `t`, in m/s^3."""
        return curve_at(self.along, t), curve_at(self.across, t)

    def steady(self) -> bool:
        """Return whether the velocity is constant; the compiler knows the answer."""
        return False


class VaryingLoad(NamedTuple):
    """A normal load that varies within a stretch."""

    force: Signal | Recording

    def at(self, t: Any) -> Any:
        """Return the normal load at time `t`, in N."""
        return value_at(self.force, t)

    def drift(self, t: Any) -> Any:
        """Return the rate of change of the load, in N/s."""
        return change_at(self.force, t)

    def constant(self) -> bool:
        """Return whether the load is constant; the compiler knows the answer."""
        return False
