"""Random faults and their models in a laboratory, each by its number: rate and state, slow drives.

The spring is up to a thousand times softer than what steady sliding needs, and a slip up to a
billion times faster than the drive; some glide on bristles.
"""

from __future__ import annotations

from math import log, pi, sqrt
from typing import Any

import stiction as st
from benchmarks.explore.draw import Draw
from benchmarks.explore.systems.set_valued import System, damping
from benchmarks.explore.systems.with_state import LAWS, Sliding, bristles, of_contacts
from stiction.presets.preset import on_a_line

APART = 5_000_011  # between numbers of drawing these and others
CYCLES = 3.0  # of loading and slip, after the first
DRIVEN = (1e-8, 1e-2)  # speeds of a drive over that of bristles


def seismic_system(seed: int, number: int) -> System:
    """Return the system of a number: on a line, or misaligned in the plane."""
    draw = Draw(seed, APART + number)
    kind: Any = draw.among(LAWS)
    if "sigma_0" in kind._fields:
        found = bristles(draw, kind, *DRIVEN)
        swings = 20.0 * pi * sqrt(found.mass / found.k)
        found = found._replace(time=found.time + swings)
    else:
        found = contacts(draw, kind)
    common = {
        "mass": found.mass,
        "k_x": found.k,
        "normal_load": found.load,
        "friction": found.law,
        "c_x": damping(draw, found.k, found.mass) * (10.0 if draw.chance(0.3) else 1.0),
        "drive": st.ConstantVelocity(found.velocity),
    }
    if draw.chance(0.6):
        slider = on_a_line(**common, driven="spring")
    else:
        k_y, phi = found.k * draw.decades(1.0, 1e3), draw.between(-20.0, 20.0)
        slider = st.Slider(
            **common, k_y=k_y, phi=f"{phi!r} deg", c_y=damping(draw, k_y, found.mass)
        )
    return System(slider, found.time, 10.0 ** -draw.between(3.0, 9.0))


def contacts(draw: Draw, kind: Any) -> Sliding:
    """Return a mass on contacts that age and weaken, and slip that outruns the drive by far."""
    load, a = draw.decades(1.0, 1e7), draw.decades(2e-3, 2e-2)
    D = draw.decades(1e-6, 1e-2)
    b, speed = a * draw.decades(1.1, 3.0), draw.decades(1e-7, 1e-5)
    law = of_contacts(draw, kind, a, b, D, speed)
    V = speed * draw.decades(1e-6, 1.0)
    k = (b - a) * load / D * draw.decades(1e-3, 1.0)
    faster = draw.decades(1e2, 1e9)
    falls = (b - a) * load * log(faster)
    mass = (falls / (faster * V)) ** 2 / k
    return Sliding(law, load, k, mass, V, (1.1 * law.mu_star * load + CYCLES * falls) / (k * V))
