"""Random apparatus, each by its number: the same on every machine."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np

import stiction as st
from benchmarks.explore.draw import Draw

SHORT, LONG = 100.0, 400.0  # periods of the faster oscillation, from the end of the first stick on
LATER = 3.0  # and so many first sticks at most
LAWS = ("exponential", "coulomb", "stribeck", "hyperbolic", "anisotropic")
SHARES = (0.4, 0.2, 0.15, 0.15, 0.1)


class System(NamedTuple):
    """An apparatus, how long it is looked at (s), and the tolerance of the run on trial.

    `start` is the initial state, by default the paper's; `delta` (m/s) regularises friction.
    """

    slider: st.Slider
    duration: float
    rtol: float
    start: st.Initial | None = None
    delta: float | None = None


def system(seed: int, number: int) -> System:
    """Return the system of a number.

    What shapes the motion is drawn free of units: the transverse oscillation's force at the
    drive's speed over the friction, and the speed of the law over the drive's.
    """
    draw = Draw(seed, number)
    mass, k_y, load = draw.decades(1e-2, 1e1), draw.decades(1e4, 1e8), draw.decades(1.0, 1e3)
    k_x = k_y / draw.decades(1.0, 3e4)
    mu = draw.between(0.05, 0.8)
    V = draw.decades(2e-3, 30.0) * mu * load / sqrt(k_y * mass)
    slider = st.Slider(
        mass=mass,
        k_x=k_x,
        k_y=k_y,
        phi=f"{misalignment(draw)!r} deg",
        normal_load=load,
        c_x=damping(draw, k_x, mass),
        c_y=damping(draw, k_y, mass),
        friction=law(draw, mu, V),
        drive=st.ConstantVelocity(V),
    )
    period = 2.0 * np.pi * sqrt(mass / k_y)
    c, s = slider.direction
    first = slider.F_0 / (V * sqrt((k_x * c) ** 2 + (k_y * s) ** 2))  # s; of the first stick
    late = min(draw.between(0.0, LATER) * first, (LONG - SHORT) * period)
    duration = first + SHORT * period + late
    return System(slider, float(duration), 10.0 ** -draw.between(3.0, 9.0))


def misalignment(draw: Draw) -> float:
    """Return an angle in degrees: none, small, or any."""
    if draw.chance(0.05):
        return 0.0
    return draw.decades(0.2, 10.0) if draw.chance(0.85) else draw.between(0.0, 90.0)


def damping(draw: Draw, stiffness: float, mass: float) -> float:
    """Return a damping coefficient, N s/m: none in half of all draws."""
    ratio = draw.decades(1e-4, 0.1) if draw.chance(0.5) else 0.0
    return 2.0 * ratio * sqrt(stiffness * mass)


def law(draw: Draw, mu: float, V: float):
    """Return a law of friction, some with a peak at rest or stronger friction at speed."""
    name = LAWS[int(np.searchsorted(np.cumsum(SHARES), draw.random(), side="right"))]
    speed = V * draw.decades(0.2, 60.0)
    kinetic = mu * (draw.between(1.0, 1.3) if draw.chance(0.1) else draw.between(0.5, 1.0))
    peak = mu * draw.between(1.01, 1.3) if draw.chance(0.2) else 0.0
    return named_law(draw, name, mu, kinetic, speed, peak)


def named_law(draw: Draw, name: str, mu: float, kinetic: float, speed: float, peak: float):
    """Return a law without states by its name, of which the rest is drawn."""
    if name == "coulomb":
        return st.Coulomb(mu, peak)
    if name == "stribeck":
        return st.laws.Stribeck(mu, kinetic, speed, d=draw.between(1.0, 3.0), mu_static=peak)
    if name == "hyperbolic":
        return st.laws.HyperbolicWeakening(mu, speed, mu_static=peak)
    simple = st.ExponentialWeakening(mu, kinetic, speed, mu_static=peak)
    if name == "exponential":
        return simple
    return st.laws.Anisotropic(simple, draw.decades(0.5, 2.0), f"{draw.between(-90.0, 90.0)!r} deg")
