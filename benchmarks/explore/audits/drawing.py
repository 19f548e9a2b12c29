"""Rigs of every kind of law, with dampers and peaks at rest."""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

import stiction as st
from benchmarks.explore.draw import Draw
from benchmarks.explore.systems.set_valued import LAWS as PLAIN
from benchmarks.explore.systems.set_valued import named_law

LAWS = (
    "exponential", "stribeck", "coulomb", "hyperbolic", "anisotropic", "table",
    "ageing", "slip", "two states", "lugre",
)  # fmt: skip


def rig(seed: int, number: int) -> st.Slider:
    """Return a rig; its slip and its drive are drawn over decades, in units of a free swing."""
    draw = Draw(seed, number)
    mass, k_x, load = draw.decades(1e-2, 20.0), draw.decades(1e2, 1e6), draw.decades(0.5, 2e3)
    k_y, mu = k_x * draw.decades(0.5, 1e4), draw.between(0.1, 0.8)
    # a rig is loaded until the spring carries friction: 0.3 to 3000 swings later
    V = mu * load / sqrt(k_x * mass) / (2.0 * pi * draw.decades(0.3, 3000.0))
    angle = 0.0 if draw.chance(0.1) else draw.decades(0.1, 60.0) * draw.among((-1.0, 1.0, 1.0))
    dampers = [
        draw.decades(1e-3, 0.3) * 2.0 * sqrt(k * mass) if draw.chance(0.3) else 0.0
        for k in (k_x, k_y)
    ]
    return st.Slider(
        mass=mass,
        k_x=k_x,
        k_y=k_y,
        phi=f"{angle!r} deg",
        normal_load=load,
        c_x=dampers[0],
        c_y=dampers[1],
        friction=law(draw, mu, V, load),
        drive=st.ConstantVelocity(V),
    )


def law(draw: Draw, mu: float, V: float, load: float) -> Any:
    """Return a law of friction: weaker or stronger at speed, some with a peak at rest."""
    name = draw.among(LAWS)
    kinetic = mu * (draw.between(1.0, 1.3) if draw.chance(0.1) else draw.between(0.5, 1.0))
    speed = V * draw.decades(0.3, 100.0)
    peak = mu * draw.between(1.01, 1.4) if draw.chance(0.2) else 0.0
    if name in PLAIN:
        return named_law(draw, name, mu, kinetic, speed, peak)
    if name == "table":
        simple = st.ExponentialWeakening(mu, kinetic, speed, mu_static=peak)
        v = [0.0, *(speed * 10.0 ** (at / 4.0) for at in range(-8, 9))]
        return st.laws.Table(v=v, mu=[simple.coefficient(each) for each in v])
    if name == "lugre":
        sigma_0 = mu * load / draw.decades(1e-7, 1e-4)
        return st.laws.LuGre(kinetic, mu, speed, sigma_0, draw.decades(0.01, 1.0) * sqrt(sigma_0))
    a, D = draw.decades(2e-3, 2e-2), draw.decades(1e-6, 1e-4)
    b = a * draw.between(0.3, 2.0)
    if name == "two states":
        return st.laws.RateStateAgeing2(a, 0.5 * b, D, 0.5 * b, 10.0 * D, mu, V)
    kind = st.laws.RateStateAgeing if name == "ageing" else st.laws.RateStateSlip
    return kind(a, b, D, mu, V)
