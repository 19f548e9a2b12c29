"""Apparatus drawn at random: any law, from the microscope's to a press's size."""

from __future__ import annotations

from math import exp, log
from typing import Any

import numpy as np

import stiction as st

PLAIN = ("coulomb", "exponential", "stribeck", "hyperbolic", "anisotropic")
WITH_STATE = ("lugre", "ageing", "slip", "ageing-2", "slip-2")


def between(random: np.random.Generator, low: float, high: float) -> float:
    """Draw a number between two, each ratio as likely as another."""
    return exp(random.uniform(log(low), log(high)))


def slider(random: np.random.Generator, laws: tuple[str, ...] = PLAIN + WITH_STATE) -> st.Slider:
    """Draw an apparatus; its scales hang together as those of one that somebody built."""
    load = between(random, 1e-9, 1e4)
    k_x = between(random, 0.02, 50.0) * load / between(random, 1e-5, 1e-2)
    f_x = between(random, 1.0, 100.0) * (1e3 if load < 1e-5 else 1.0)
    mass = k_x / (2.0 * np.pi * f_x) ** 2
    damped = random.random() < 0.4
    V = between(random, 1e-5, 3e-2)
    return st.Slider(
        mass=mass,
        k_x=k_x,
        k_y=k_x * between(random, 0.5, 1e4),
        phi=f"{random.choice([0.0, 90.0, random.uniform(-90, 90), random.uniform(0, 12)])} deg",
        normal_load=load,
        c_x=random.uniform(0.0, 0.3) * 2.0 * (k_x * mass) ** 0.5 if damped else 0.0,
        c_y=random.uniform(0.0, 0.3) * 2.0 * (k_x * mass) ** 0.5 if damped else 0.0,
        friction=law(random, str(random.choice(laws)), V, load),
        drive=st.ConstantVelocity(V),
    )


def law(random: np.random.Generator, kind: str, V: float, load: float) -> Any:
    """Draw a law whose speed is within two decades of the drive's."""
    high = random.uniform(0.1, 0.9)
    low = high * random.uniform(0.4, 1.1)
    v = V * between(random, 0.1, 100.0)
    if kind == "coulomb":
        return st.Coulomb(low, mu_static=max(low, high))
    if kind == "exponential":
        return st.ExponentialWeakening(high, low, v)
    if kind == "stribeck":
        c = 0.1 * low / v if random.random() < 0.3 else 0.0
        return st.laws.Stribeck(high, low, v, d=random.uniform(1.0, 3.0), c=c)
    if kind == "hyperbolic":
        return st.laws.HyperbolicWeakening(high, v)
    if kind == "anisotropic":
        inner = st.ExponentialWeakening(high, low, v)
        return st.laws.Anisotropic(
            inner, random.uniform(0.6, 1.6), f"{random.uniform(-80, 80)} deg"
        )
    if kind == "lugre":
        stiff = load * between(random, 1e2, 1e5)
        # damping of the bristles in proportion to the root of their stiffness
        return st.laws.LuGre(
            low, high, v, stiff, load * between(random, 0.1, 100.0), 0.1 * low * load
        )
    a = random.uniform(0.004, 0.02)
    D, V_star = between(random, 1e-6, 1e-4), V * between(random, 0.01, 100.0)
    mu_star = random.uniform(0.3, 0.8)
    kinds = {"ageing": st.laws.RateStateAgeing, "slip": st.laws.RateStateSlip}
    if kind in kinds:
        return kinds[kind](a, a * random.uniform(0.3, 2.0), D, mu_star, V_star)
    two = {"ageing-2": st.laws.RateStateAgeing2, "slip-2": st.laws.RateStateSlip2}[kind]
    b = a * random.uniform(0.3, 2.0)
    return two(a, 0.6 * b, D, 0.4 * b, 10.0 * D, mu_star, V_star)
