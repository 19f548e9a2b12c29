"""Random apparatus whose friction law has internal states, each by its number.

Some of a misaligned mass in the plane, some in one dimension, where slip turns back through rest.
"""

from __future__ import annotations

from math import sqrt
from typing import Any, NamedTuple

import stiction as st
from benchmarks.explore.draw import Draw
from benchmarks.explore.systems.set_valued import System, damping
from stiction.presets.preset import on_a_line

LAWS = (
    st.laws.LuGre,
    st.laws.LuGreHyperbolic,
    st.laws.RateStateAgeing,
    st.laws.RateStateSlip,
    st.laws.RateStatePerrin,
    st.laws.RateStateAgeing2,
    st.laws.RateStateSlip2,
)

DRIVEN = (0.02, 20.0)  # speeds of a drive over that of bristles


class Sliding(NamedTuple):
    """A law under a load (N), the stiffness of the drive's spring (N/m), mass (kg), drive (m/s).

    `time` is how long (s) the spring needs for what friction can hold, or states to change.
    """

    law: Any
    load: float
    k: float
    mass: float
    velocity: float
    time: float


def state_system(seed: int, number: int) -> System:
    """Return the system of a number."""
    draw = Draw(seed, number)
    kind: Any = draw.among(LAWS)
    law, load, k, mass, V, time = (
        bristles(draw, kind, *DRIVEN) if "sigma_0" in kind._fields else contacts(draw, kind)
    )
    common = {"mass": mass, "k_x": k, "normal_load": load, "friction": law}
    if draw.chance(0.5):
        drive = st.ConstantVelocity(V)
        if draw.chance(0.5):
            pieces = [st.protocols.Constant(V * f, duration=3.0 * time) for f in steps(draw)]
            drive = st.protocols.DriveProgram(velocity=V, program=pieces)
        slider = on_a_line(**common, c_x=damping(draw, k, mass), drive=drive, driven="spring")
    else:
        k_y, phi = k * draw.decades(2.0, 1e3), draw.between(-5.0, 5.0)
        slider = st.Slider(
            **common,
            k_y=k_y,
            phi=f"{phi!r} deg",
            c_x=damping(draw, k, mass),
            c_y=damping(draw, k_y, mass),
            drive=st.ConstantVelocity(V),
        )
    return System(slider, 9.0 * time, 10.0 ** -draw.between(2.0, 9.0))


def steps(draw: Draw) -> list[float]:
    """Return the speeds of a velocity-step test over the first."""
    return [1.0, draw.decades(0.2, 5.0), draw.decades(0.2, 5.0)]


def bristles(draw: Draw, kind: Any, slowest: float, fastest: float) -> Sliding:
    """Return a mass on bristles, softly to hardly damped, that weaken with speed.

    It is driven at one of the speeds between two, over that of the law.
    """
    load, mass, stiff = draw.decades(0.1, 30.0), draw.decades(1e-3, 10.0), draw.decades(1e3, 1e6)
    mu, speed = draw.between(0.2, 0.8), draw.decades(1e-4, 0.1)
    damped = 2.0 * draw.decades(0.05, 2.0) * sqrt(stiff * mass)
    viscous = draw.decades(1e-3, 1.0) * 0.1 * mu * load / speed
    if kind is st.laws.LuGre:
        law = kind(mu, mu * draw.between(1.0, 1.6), speed, stiff, damped, viscous)
    else:
        law = kind(mu, speed, stiff, damped, viscous)
    k, V = stiff * draw.decades(1e-4, 0.3), speed * draw.decades(slowest, fastest)
    return Sliding(law, load, k, mass, V, 1.5 * mu * load / (k * V))


def contacts(draw: Draw, kind: Any) -> Sliding:
    """Return a mass on contacts that age: weakening or strengthening, stiff or soft."""
    load, a, D = draw.decades(0.1, 30.0), draw.decades(2e-3, 2e-2), draw.decades(1e-6, 1e-4)
    b, speed = a * draw.decades(0.4, 3.0), draw.decades(1e-7, 1e-4)
    law = of_contacts(draw, kind, a, b, D, speed)
    V = speed * draw.decades(0.05, 20.0)
    k = max(b - a, 0.2 * a) * load / D * draw.decades(0.2, 5.0)
    mass = k * (D / V) ** 2 * draw.decades(1e-10, 1.0)
    return Sliding(law, load, k, mass, V, 3.0 * max(D / V, law.mu_star * load / (k * V)))


def of_contacts(draw: Draw, kind: Any, a: float, b: float, D: float, speed: float) -> Any:
    """Return a law of contacts that age, whose states share `b` if there are two."""
    states: tuple[float, ...] = (b, D)
    if len(kind.states()) == 2:
        states = (0.5 * b, D, 0.5 * b, D * draw.decades(2.0, 30.0))
    return kind(a, *states, draw.between(0.3, 0.8), speed)
