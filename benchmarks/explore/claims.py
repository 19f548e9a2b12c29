"""``python -m benchmarks.explore.claims``: properties of random runs beside their error.

A sample inside a step is what a run that ends there gives. Units that differ by powers of two
change no bit. The residual of the energy budget keeps its bound. A vibration about steady sliding,
however small, is that of linear theory. Exit status 1 if one is broken.
"""

from __future__ import annotations

import argparse
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from math import hypot
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import expm

import stiction as st
from benchmarks.explore.draw import Draw
from benchmarks.explore.systems.set_valued import System, system
from stiction.solver.accuracy import tolerance

SAMPLES = 5  # of a run
PERIODS = 12.0  # of the faster oscillation, after the first stick
POWERS = 60  # of two, at most
BOUNDS = {"sample": 1.0, "units": 0.0, "energy": 1.0, "vibration": 1.0}


class Claim(NamedTuple):
    """By how much each claim is missed, over its bound."""

    number: int
    sample: float
    units: float
    energy: float
    vibration: float


def look(seed: int, number: int) -> Claim:
    """Hold one system to its claims."""
    draw, drawn = Draw(seed + 1, number), system(seed, number)
    slider = drawn.slider
    period = 2.0 * np.pi * np.sqrt(slider.mass / max(slider.k_x, slider.k_y))
    (c, s), V = slider.direction, slider.motion.rate(0.0)[0]
    first = slider.F_0 / (V * np.hypot(slider.k_x * c, slider.k_y * s))
    short = System(slider, float(first + PERIODS * period), drawn.rtol)
    return Claim(
        number, sample(short, draw), units(short, draw), energy(short), vibration(slider, draw)
    )


def sample(of: System, draw: Draw) -> float:
    """Return how far samples are from runs that end there, over what a step may err by."""
    rate = draw.between(37.0, 97.0) / of.duration
    run = st.simulate(of.slider, of.duration, sample_rate=rate, rtol=of.rtol)
    V, worst = of.slider.motion.rate(0.0)[0], 0.0
    moving = np.flatnonzero(run.data["slip_speed"].values[1:] > 0.0)[:: max(1, 90 // SAMPLES)] + 1
    for k in moving:
        end = st.simulate(of.slider, float(run.data["time"][k]), rtol=of.rtol).final
        found = (float(run.data[name][k]) - float(end[name]) for name in ("slip_x", "slip_y"))
        worst = max(
            worst, float(hypot(*found)) / (tolerance(of.rtol) * (V + float(end["slip_speed"])))
        )
    return worst


def units(of: System, draw: Draw) -> float:
    """Return 1 if units of mass, length and time that differ by powers of two change a bit."""
    law: Any = of.slider.law
    if type(law) is not st.Coulomb and type(law) is not st.ExponentialWeakening:
        return 0.0
    m, x, t = (2.0 ** round(draw.between(-POWERS, POWERS)) for _ in range(3))
    numbers = law._asdict()
    if "v_f" in numbers:
        numbers["v_f"] *= x / t
    s, V = of.slider, of.slider.motion.rate(0.0)[0]
    scaled = s.replace(
        mass=s.mass * m,
        k_x=s.k_x * m / t**2,
        k_y=s.k_y * m / t**2,
        c_x=s.c_x * m / t,
        c_y=s.c_y * m / t,
        normal_load=s.normal_load * m * x / t**2,
        friction=type(law)(**numbers),
        drive=st.ConstantVelocity(V * x / t),
    )
    one = st.simulate(s, of.duration, rtol=of.rtol, multiscale=False)
    other = st.simulate(scaled, of.duration * t, rtol=of.rtol, multiscale=False)
    same = np.array_equal(one.stick_intervals * t, other.stick_intervals)
    return 0.0 if same and float(one.final["u_y"]) * x == float(other.final["u_y"]) else 1.0


def energy(of: System) -> float:
    """Return the residual of the energy budget over its bound."""
    budget = st.analysis.energy_budget(st.simulate(of.slider, of.duration, rtol=of.rtol))
    return float((np.abs(budget["residual"]) / budget["bound"]).max())


def vibration(slider: st.Slider, draw: Draw) -> float:
    """Return the error of a ring-down over 1e-3 of its amplitude; 0 where sliding is unstable."""
    (c, s), V = slider.direction, slider.motion.rate(0.0)[0]
    law: Any = slider.law
    if isinstance(law, st.laws.Anisotropic):
        return 0.0
    K, W = np.diag([slider.k_x, slider.k_y]), slider.F_0 / law.coefficient(0.0)
    F, slope = W * law.coefficient(V), W * law.slope(V)
    along, across = np.array([c, s]), np.array([-s, c])
    damping = np.diag([slider.c_x, slider.c_y]) + slope * np.outer(along, along)
    damping += F / V * np.outer(across, across)
    generator = np.block(
        [[np.zeros((2, 2)), np.eye(2)], [-K / slider.mass, -damping / slider.mass]]
    )
    if np.linalg.eigvals(generator).real.max() > 0.0:
        return 0.0
    omega = np.sqrt(np.diag(K) / slider.mass)
    steady = np.linalg.solve(K, F * along)
    # so small that what is quadratic in it does not show, and well above rounding
    speed = min(V, F / max(abs(slope), 1e-300)) * draw.decades(1e-7, 1e-6)
    if speed < 1e-8 * (V + np.abs(F / (slider.mass * omega)).sum()):
        return 0.0
    start = st.Initial(
        u_x=steady[0] + speed / omega[0], u_y=steady[1] + speed / omega[1], v_x=0.0, v_y=0.0
    )
    off = np.array([start.u_x, start.u_y]) - steady
    duration = draw.between(0.3, 3.0) * 2.0 * np.pi / omega.min()
    final = st.simulate(slider, float(duration), initial=start).final
    found = np.array([float(final["u_x"]), float(final["u_y"])]) - steady
    want = (expm(duration * generator) @ [*off, 0.0, 0.0])[:2]
    return float(np.linalg.norm((found - want) * omega) / (1e-3 * speed))


def main() -> int:
    """Look at the systems asked for; return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.explore.claims")
    parser.add_argument("--systems", type=int, default=300, help="how many")
    parser.add_argument("--seed", type=int, default=1, help="of all that is random")
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args()
    with ProcessPoolExecutor(options.processes) as pool:
        seen = list(pool.map(partial(look, options.seed), range(options.systems), chunksize=4))
    broken = 0
    for name, bound in BOUNDS.items():
        values = np.array([getattr(each, name) for each in seen])
        worst = int(values.argmax())
        broken += int((values > bound).sum())
        print(f"{name}: worst {values[worst]:.2g} of its bound, in system {seen[worst].number}")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
