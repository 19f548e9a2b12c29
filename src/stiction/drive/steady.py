"""Constant drive velocity and constant normal load: stretches without end."""

from __future__ import annotations

from typing import Any, NamedTuple

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
