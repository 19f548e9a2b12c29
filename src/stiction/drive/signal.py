"""A smooth stretch of a drive or of a normal load, for the compiled solver.

Between the instants at which a program jumps or bends, the drive velocity and the normal load
are a straight line in time plus harmonics; the solver integrates one such stretch after the other
and never meets a jump. The plain functions here work on floats, on arrays of times, and in
compiled code.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class Signal(NamedTuple):
    """value + slope (t - start) + two harmonics, each amplitude sin(omega t + phase).

    Units are those of the quantity; t and start in s, omega in rad/s, phase in rad.
    """

    start: float
    value: float
    slope: float = 0.0
    amplitude: float = 0.0
    omega: float = 0.0
    phase: float = 0.0
    amplitude_2: float = 0.0
    omega_2: float = 0.0
    phase_2: float = 0.0


def signal_at(s: Signal, t: float) -> float:
    """Return the value at time `t`."""
    y = s.value + s.slope * (t - s.start)
    if s.amplitude != 0.0:
        y += s.amplitude * np.sin(s.omega * t + s.phase)
    if s.amplitude_2 != 0.0:
        y += s.amplitude_2 * np.sin(s.omega_2 * t + s.phase_2)
    return y


def signal_change(s: Signal, t: float) -> float:
    """Return the derivative at time `t`."""
    y = s.slope
    if s.amplitude != 0.0:
        y += s.amplitude * s.omega * np.cos(s.omega * t + s.phase)
    if s.amplitude_2 != 0.0:
        y += s.amplitude_2 * s.omega_2 * np.cos(s.omega_2 * t + s.phase_2)
    return y


def signal_curve(s: Signal, t: float) -> float:
    """Return the second derivative at time `t`."""
    y = 0.0
    if s.amplitude != 0.0:
        y -= s.amplitude * s.omega * s.omega * np.sin(s.omega * t + s.phase)
    if s.amplitude_2 != 0.0:
        y -= s.amplitude_2 * s.omega_2 * s.omega_2 * np.sin(s.omega_2 * t + s.phase_2)
    return y


def signal_sum(s: Signal, t: float, dt: float) -> float:
    """Return the integral from `t` to `t + dt`, without cancellation for short `dt`."""
    middle = t + 0.5 * dt
    y = (s.value + s.slope * (middle - s.start)) * dt
    if s.amplitude != 0.0:
        y += (
            2.0
            * s.amplitude
            / s.omega
            * np.sin(s.omega * middle + s.phase)
            * np.sin(0.5 * s.omega * dt)
        )
    if s.amplitude_2 != 0.0:
        y += (
            2.0
            * s.amplitude_2
            / s.omega_2
            * np.sin(s.omega_2 * middle + s.phase_2)
            * np.sin(0.5 * s.omega_2 * dt)
        )
    return y


def signal_bounds(s: Signal, start: float, end: float) -> tuple[float, float, float, float]:
    """Return bounds of the magnitudes of the value and its first three derivatives."""
    line = max(abs(s.value + s.slope * (t - s.start)) for t in (start, end))
    bounds = [line, abs(s.slope), 0.0, 0.0]
    for amplitude, omega in ((s.amplitude, s.omega), (s.amplitude_2, s.omega_2)):
        for n in range(4):
            bounds[n] += abs(amplitude) * abs(omega) ** n
    return bounds[0], bounds[1], bounds[2], bounds[3]


class Course(NamedTuple):
    """A stretch of a drive: its velocity along X and across it."""

    along: Signal
    across: Signal

    def travel(drive, t: float, dt: float) -> tuple[float, float]:
        """Return the displacement from time `t` to `t + dt`, in m."""
        return signal_sum(drive.along, t, dt), signal_sum(drive.across, t, dt)

    def rate(drive, t: float) -> tuple[float, float]:
        """Return the velocity at time `t`, in m/s."""
        return signal_at(drive.along, t), signal_at(drive.across, t)

    def rate_change(drive, t: float) -> tuple[float, float]:
        """Return the acceleration at time `t`, in m/s^2."""
        return signal_change(drive.along, t), signal_change(drive.across, t)

    def rate_curve(drive, t: float) -> tuple[float, float]:
        """Return the rate of change of the acceleration at time `t`, in m/s^3."""
        return signal_curve(drive.along, t), signal_curve(drive.across, t)

    def steady(drive) -> bool:
        """Return whether the velocity is constant; the compiler knows the answer."""
        return False


class Loading(NamedTuple):
    """A stretch of a normal load."""

    force: Signal

    def at(load, t: float) -> float:
        """Return the normal load at time `t`, in N."""
        return signal_at(load.force, t)

    def drift(load, t: float) -> float:
        """Return the rate of change of the load, in N/s."""
        return signal_change(load.force, t)

    def constant(load) -> bool:
        """Return whether the load is constant; the compiler knows the answer."""
        return False


# called by the methods above, compiled with them
FUNCTIONS = (signal_at, signal_change, signal_curve, signal_sum)
