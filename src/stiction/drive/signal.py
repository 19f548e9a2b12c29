"""A drive velocity or a normal load between two jumps: a straight line in time plus harmonics.

The methods work on floats, on arrays of times, and in compiled code. The functions before them
serve signals and recordings alike: compiled code calls the method of the type (see
`stiction.solver.problem.by_type`).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np


def value_at(s: Any, t: Any) -> Any:
    """Return the value of a signal or a recording at time `t`."""
    return s.value_at(t)


def change_at(s: Any, t: Any) -> Any:
    """Return its derivative."""
    return s.change_at(t)


def curve_at(s: Any, t: Any) -> Any:
    """Return its second derivative."""
    return s.curve_at(t)


def sum_over(s: Any, t: Any, dt: Any) -> Any:
    """Return its integral from `t` to `t + dt`, without cancellation for short `dt`."""
    return s.sum_over(t, dt)


# called by the methods of stretches, compiled with them
FUNCTIONS = (value_at, change_at, curve_at, sum_over)


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

    def value_at(self, t: float) -> float:
        """Return the value at time `t`."""
        y = self.value + self.slope * (t - self.start)
        if self.amplitude != 0.0:
            y += self.amplitude * np.sin(self.omega * t + self.phase)
        if self.amplitude_2 != 0.0:
            y += self.amplitude_2 * np.sin(self.omega_2 * t + self.phase_2)
        return y

    def change_at(self, t: float) -> float:
        """Return the derivative at time `t`."""
        y = self.slope
        if self.amplitude != 0.0:
            y += self.amplitude * self.omega * np.cos(self.omega * t + self.phase)
        if self.amplitude_2 != 0.0:
            y += self.amplitude_2 * self.omega_2 * np.cos(self.omega_2 * t + self.phase_2)
        return y

    def curve_at(self, t: float) -> float:
        """Return the second derivative at time `t`."""
        y = 0.0
        if self.amplitude != 0.0:
            y -= self.amplitude * self.omega * self.omega * np.sin(self.omega * t + self.phase)
        if self.amplitude_2 != 0.0:
            y -= (
                self.amplitude_2
                * self.omega_2
                * self.omega_2
                * np.sin(self.omega_2 * t + self.phase_2)
            )
        return y

    def sum_over(self, t: float, dt: float) -> float:
        """Return the integral from `t` to `t + dt`, without cancellation for short `dt`."""
        middle = t + 0.5 * dt
        y = (self.value + self.slope * (middle - self.start)) * dt
        if self.amplitude != 0.0:
            y += (
                2.0
                * self.amplitude
                / self.omega
                * np.sin(self.omega * middle + self.phase)
                * np.sin(0.5 * self.omega * dt)
            )
        if self.amplitude_2 != 0.0:
            y += (
                2.0
                * self.amplitude_2
                / self.omega_2
                * np.sin(self.omega_2 * middle + self.phase_2)
                * np.sin(0.5 * self.omega_2 * dt)
            )
        return y

    def bounds_between(self, start: float, end: float) -> tuple[float, float, float, float]:
        """Return bounds of the magnitudes of the value and its first three derivatives."""
        line = max(abs(self.value + self.slope * (t - self.start)) for t in (start, end))
        bounds = [line, abs(self.slope), 0.0, 0.0]
        for amplitude, omega in ((self.amplitude, self.omega), (self.amplitude_2, self.omega_2)):
            for n in range(4):
                bounds[n] += abs(amplitude) * abs(omega) ** n
        return bounds[0], bounds[1], bounds[2], bounds[3]

    def fastest(self) -> float:
        """Return the largest angular frequency, rad/s; 0 without harmonics."""
        waves = ((self.amplitude, self.omega), (self.amplitude_2, self.omega_2))
        return max((abs(omega) for amplitude, omega in waves if amplitude != 0.0), default=0.0)

    def may_vanish(self, start: float, end: float) -> Iterator[tuple[float, float]]:
        """Yield the intervals (s) in which the value may reach zero: all."""
        yield start, end
