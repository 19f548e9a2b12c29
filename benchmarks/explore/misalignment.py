"""``python -m benchmarks.explore.misalignment``: the angle that a force alone implies.

Each rig is simulated, its force given noise up to a hundredth of the drop and a stiffness that is
off by up to 2 %, and the angle found is held against the true one. Of the intervals that are told,
95 % should hold it; 90 % are asked for, and no angle off by a factor of three. With ``--creep``
the angle is that of the creep of whole runs, at up to 25 deg and under three laws, with ``--soft``
on springs across that are hardly stiffer; then the record of a force states the stiffness across.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from math import cos, degrees, exp, log, pi, radians, sqrt
from typing import NamedTuple

import numpy as np
from rich.console import Console

import stiction as st

COVERED, FACTOR = 0.9, 3.0
SOFT = 0.2, 2.5  # powers of ten of k_y/k_x
LONGEST_RUN = 2e5  # transverse periods in a run
STICKING = ("stick-slip", "transitional oscillation")
Generator = np.random.Generator


class Seen(NamedTuple):
    """True and found angle, its standard error (rad), or the reason for which there is none."""

    true: float
    found: float
    error: float
    reason: str


def rig(rng: Generator, across: tuple[float, float]) -> st.Slider:
    """Return a random rig that is driven slowly enough to stick.

    The spring across is stiffer by a factor between powers of ten.
    """

    def between(low: float, high: float) -> float:
        return exp(rng.uniform(log(low), log(high)))

    k_x = between(100.0, 4e5)
    mu_0, v_f = rng.uniform(0.15, 0.7), between(2e-3, 2e-2)
    return st.Slider(
        mass=between(0.05, 1.0) * (k_x / 1e3) ** 0.5,
        k_x=k_x,
        k_y=k_x * 10 ** rng.uniform(*across),
        phi=f"{radians(rng.uniform(0.5, 5.0))!r} rad",
        normal_load=between(2.0, 40.0) * (k_x / 1e3) ** 0.7,
        friction=st.ExponentialWeakening(mu_0=mu_0, mu_inf=mu_0 * rng.uniform(0.5, 0.85), v_f=v_f),
        drive=st.ConstantVelocity(v_f * between(0.005, 0.3)),
    )


def look(rng: Generator, noise: float, off: float, soft: bool) -> Seen | None:
    """Return what is seen of one rig; None if it does not stick and slip at least three times."""
    slider = rig(rng, SOFT if soft else (2.0, 4.0))
    V, F_0 = slider.motion.velocity, slider.F_0
    weakens = 1.0 - slider.friction.mu_inf / slider.friction.mu_0
    period = 2.0 * weakens * F_0 / slider.k_x / V
    duration = F_0 / slider.k_x / V + rng.uniform(4.0, 9.0) * period
    rate = rng.uniform(300.0, 3000.0) / period
    if duration * sqrt(slider.k_y / slider.mass) / (2.0 * pi) > LONGEST_RUN:
        return None
    run = st.simulate(slider, duration, sample_rate=rate)
    cycles = st.analysis.find_cycles(run)
    if cycles.sizes["cycle"] < 3 or st.analysis.classify(run).kind not in STICKING:
        return None
    force = run.data["spring_x"].values
    hiss = rng.uniform(0.0, noise) * float(cycles["drop"].median())
    record = st.Record(
        time=run.data["time"].values,
        force=force + hiss * rng.standard_normal(len(force)),
        stiffness=slider.k_x * (1.0 + rng.uniform(-off, off)),
        stiffness_across=slider.k_y * (1.0 + rng.uniform(-0.1, 0.1)) if soft else None,
        drive_velocity=V * cos(slider.phi),
    )
    try:
        found = st.analysis.misalignment_from_force(record)
    except st.ResultError as error:
        return Seen(slider.phi, np.nan, np.nan, str(error))
    return Seen(slider.phi, found.phi, found.phi_error, "")


def look_at_creep(rng: Generator, across: tuple[float, float]) -> Seen | None:
    """Return the angle that the creep of a random run implies; None if it does not end.

    The spring across is stiffer by a factor between powers of ten.
    """

    def power(low: float, high: float) -> float:
        return float(10 ** rng.uniform(low, high))

    mass, k_x, load, mu = power(-2, 1), power(2.5, 4.5), power(0, 2), rng.uniform(0.1, 0.6)
    slip_length, frequency = mu * load / k_x, sqrt(k_x / mass) / (2.0 * pi)
    V = slip_length * frequency / power(0.3, 2)
    law = (
        st.ExponentialWeakening(mu, mu * rng.uniform(0.5, 1.1), V * power(0, 1.5)),
        st.Coulomb(mu),
        st.laws.Stribeck(mu, mu * rng.uniform(0.6, 0.95), V * power(0, 1.5)),
    )[rng.integers(3)]
    slider = st.Slider(
        mass=mass,
        k_x=k_x,
        k_y=k_x * power(*across),
        phi=f"{rng.uniform(0.5, 25.0)!r} deg",
        normal_load=load,
        friction=law,
        drive=st.ConstantVelocity(V),
    )
    duration = 3.0 * slip_length / V
    run = st.simulate(slider, duration, sample_rate=4000.0 / duration, max_steps=1_000_000)
    if not run.status.ok:
        return None
    found = st.analyse(run)
    if found.misalignment is None:
        return Seen(slider.phi, np.nan, np.nan, found.missing["misalignment"])
    return Seen(slider.phi, found.misalignment.phi, found.misalignment.phi_error, "")


def main() -> int:
    """Look at as many rigs as are asked for; return 1 if a bound is broken."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.explore.misalignment")
    parser.add_argument("--rigs", type=int, default=100, help="that stick and slip")
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--noise", type=float, default=0.01, help="of the drop, at most")
    parser.add_argument("--off", type=float, default=0.02, help="of the stiffness, at most")
    parser.add_argument("--creep", action="store_true", help="of whole runs, not of their force")
    parser.add_argument("--soft", action="store_true", help="springs across down to 1.5 k_x")
    options = parser.parse_args()
    soft, across = options.soft, SOFT if options.soft else (2.5, 4.5)
    rng, seen = np.random.default_rng(options.seed), list[Seen]()
    while len(seen) < options.rigs:
        if options.creep:
            one = look_at_creep(rng, across)
        else:
            one = look(rng, options.noise, options.off, soft)
        if one is not None:
            seen.append(one)
    return report(Console(), seen)


def report(console: Console, seen: list[Seen]) -> int:
    """Say what was seen; return 1 if a bound is broken."""
    known = [each for each in seen if not each.reason]
    if not known:
        console.print(f"{len(seen)} rigs, none determined")
        return 1
    z = np.array([(each.found - each.true) / each.error for each in known])
    ratio = np.array([each.found / each.true for each in known])
    covered, worst = float(np.mean(np.abs(z) < 2.0)), float(np.exp(np.abs(np.log(ratio)).max()))
    console.print(
        f"{len(seen)} rigs, {len(known)} determined; intervals hold {covered:.1%} of them; off by "
        f"a factor of {worst:.2f} at most; median standard error "
        f"{np.median([each.error / each.found for each in known]):.1%}"
    )
    for each, sigma in zip(known, z, strict=True):
        if abs(sigma) > 2.0:
            pair = f"{degrees(each.true):.2f} deg, found {degrees(each.found):.2f}"
            console.print(f"  outside: {pair} ± {degrees(each.error):.2f}")
    reasons = Counter(each.reason.split(";")[0][:70] for each in seen if each.reason)
    for reason, count in reasons.most_common(5):
        console.print(f"  {count} {reason}")
    return int(covered < COVERED or worst > FACTOR)


if __name__ == "__main__":
    sys.exit(main())
