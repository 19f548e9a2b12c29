"""Random apparatus whose drive is slow beside what friction can do, each by its number.

So are plates of the earth's crust, and creep machines: a stick lasts up to a billion swings.
"""

from __future__ import annotations

from math import hypot, pi, sqrt

import stiction as st
from benchmarks.explore.draw import Draw
from benchmarks.explore.systems.set_valued import SHORT, System, law, system
from benchmarks.explore.systems.unsteady import APART

SLOWEST, SLOW = 1e-8, 1e-2  # of the speed that friction can give the mass on its softer spring


def slow_system(seed: int, number: int) -> System:
    """Return the system of a number: from rest on, or from shortly before its first slip."""
    draw, drawn = Draw(seed, 2 * APART + number), system(seed, number)
    slider, rtol = drawn.slider, drawn.rtol
    soft = min(slider.k_x, slider.k_y)
    V = draw.decades(SLOWEST, SLOW) * slider.F_0 / sqrt(soft * slider.mass)
    mu = slider.F_0 / slider.normal_load
    slider = slider.replace(
        drive=st.ConstantVelocity(V), friction=law(draw, mu, V * draw.decades(1.0, 1e3))
    )
    c, s = slider.direction
    first = slider.F_0 / (V * hypot(slider.k_x * c, slider.k_y * s))  # s; of the first stick
    swings = SHORT * 2.0 * pi * sqrt(slider.mass / soft)
    if draw.chance(0.5):
        return System(slider, first + swings, rtol)
    held = V * max(first - 0.1 * swings, 0.0)
    return System(slider, swings, rtol, st.Initial(u_x=held * c, u_y=held * s))
