"""What pulls and what presses: motion of the driven spring end, and normal load, in time.

A drive moves in the laboratory plane (X along the nominal drive direction, Y across
it). The equations are Eq. (1) for the spring's elongation, which read literally has the
plate driven under a mass whose spring is held at rest (the paper's Fig. 1); at constant
velocity that is the same as a spring end pulled over a resting floor (Fig. 2). With
acceleration the two differ by the inertia m dv_d/dt, which Eq. (1) has and is kept here.

Like friction laws, drives and loads are NamedTuples of floats whose methods the solver
compiles; their first argument is the drive or load itself.
"""

from __future__ import annotations

from math import inf
from typing import Any, NamedTuple, Protocol

from stiction.tables import choose
from stiction.units import Force, Velocity
from stiction.validation import validated


class Drive(Protocol):
    """What the solver asks of a drive; vectors are (X, Y)."""

    @property
    def _fields(self) -> tuple[str, ...]: ...

    def _asdict(self) -> dict[str, Any]: ...

    def travel(drive, t: float, dt: float) -> tuple[float, float]:
        """Return the displacement from time `t` to `t + dt`, in m."""

    def rate(drive, t: float) -> tuple[float, float]:
        """Return the velocity at time `t`, in m/s."""

    def rate_change(drive, t: float) -> tuple[float, float]:
        """Return the acceleration at time `t`, in m/s^2."""

    def next_break(drive, t: float) -> float:
        """Return the first time after `t` at which the velocity or its derivative jumps."""


class Load(Protocol):
    """What the solver asks of a normal load."""

    @property
    def _fields(self) -> tuple[str, ...]: ...

    def _asdict(self) -> dict[str, Any]: ...

    def at(load, t: float) -> float:
        """Return the normal load at time `t`, in N."""


@validated
class ConstantVelocity(NamedTuple):
    """The spring's far end moves along X with a constant velocity from t = 0 on.

    Parameters
    ----------
    velocity : float or str
        V, in m/s.
    """

    velocity: Velocity

    def travel(drive, t: float, dt: float) -> tuple[float, float]:
        """Return V dt along X."""
        return drive.velocity * dt, 0.0

    def rate(drive, t: float) -> tuple[float, float]:
        """Return V along X."""
        return drive.velocity, 0.0

    def rate_change(drive, t: float) -> tuple[float, float]:
        """Return zero."""
        return 0.0, 0.0

    def next_break(drive, t: float) -> float:
        """Return infinity: nothing ever changes."""
        return inf


@validated
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


DRIVES: dict[str, type[Drive]] = {"constant-velocity": ConstantVelocity}


def read_drive(table: dict[str, Any]) -> Drive:
    """Read a description's table [drive]; without a key ``motion`` the velocity is constant."""
    drive: Drive = choose(table, "motion", DRIVES, default="constant-velocity")
    return drive
