"""Random planar rigs, each by its number: the same on every machine."""

from __future__ import annotations

from math import sqrt

import numpy as np

import stiction as st
from benchmarks.explore.draw import Draw
from benchmarks.explore.systems.set_valued import LAWS, System, damping, named_law

PERIODS = (3.0, 12.0)  # of the faster oscillation, from the end of the first stick on


def rig(seed: int, number: int) -> System:
    """Return the rig of a number: its slider, how long it is looked at, and a tolerance."""
    draw = Draw(seed, number)
    mass, k_y, load = draw.decades(1e-2, 1e1), draw.decades(1e4, 1e7), draw.decades(1.0, 1e3)
    k_x = k_y / draw.decades(1.0, 1e3)
    mu = draw.between(0.05, 0.8)
    V = draw.decades(2e-2, 10.0) * mu * load / sqrt(k_y * mass)
    law = named_law(draw, draw.among(LAWS), mu, mu * draw.between(0.5, 1.1), 20.0 * V, 0.0)
    slider = st.Slider(
        mass=mass,
        mass_y=mass * draw.decades(0.2, 5.0),
        mass_angle=angle(draw),
        k_x=k_x,
        k_y=k_y,
        phi=f"{draw.between(-89.0, 89.0)!r} deg",
        normal_load=load,
        c_x=damping(draw, k_x, mass),
        c_y=damping(draw, k_y, mass),
        damping_angle=angle(draw),
        friction=law,
        drive=st.ConstantVelocity(V),
    )
    if draw.chance(0.4):
        slider = slider.replace(springs=springs(draw, k_x, k_y))
    fast = slider.natural_frequencies[1]
    c, s = slider.direction
    first = slider.F_0 / (V * sqrt((slider.k_x * c) ** 2 + (slider.k_y * s) ** 2))
    duration = first + draw.between(*PERIODS) / fast
    return System(slider, float(duration), 10.0 ** -draw.between(4.0, 8.0))


def angle(draw: Draw) -> str:
    """Return an angle: none, or any."""
    return "0 deg" if draw.chance(0.2) else f"{draw.between(-90.0, 90.0)!r} deg"


def springs(draw: Draw, k_x: float, k_y: float) -> list[st.Spring]:
    """Return two to four springs in series of about these stiffnesses, some rigid along an axis."""
    count = 2 + int(draw.random() * 3)
    return [
        st.Spring(
            f"part {number}",
            k_x * draw.decades(1.0, 30.0),
            np.inf if number and draw.chance(0.3) else k_y * draw.decades(1.0, 30.0),
            angle=f"{draw.between(-20.0, 20.0)!r} deg" if draw.chance(0.7) else "0 deg",
        )
        for number in range(count)
    ]
