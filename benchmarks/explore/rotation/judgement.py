"""Random rigs, their records with a force across, and what is said of them beside the truth."""

from __future__ import annotations

from math import pi, sqrt
from typing import NamedTuple

import numpy as np

import stiction as st
from benchmarks.explore.misalignment import LONGEST_RUN, Generator, rig
from stiction.analysis.rotation.findings import (
    BOTH,
    GROWING,
    HALF,
    MOST_GROWTH,
    SOME_GROWTH,
    TURNING,
    UNDETERMINED,
)
from stiction.analysis.rotation.loading import loadings

NEAR = 0.05  # of the rise: a truth so close to the limit of two conclusions is of either
SPEEDS = {st.ExponentialWeakening, st.laws.Stribeck}  # laws with one F_0, that at rest


class Judged(NamedTuple):
    """True and stated conclusion, and each number's error over its standard error."""

    true: str
    told: str
    right: bool
    errors: dict[str, float]


def slider_of(rng: Generator) -> st.Slider:
    """Return a random rig with a random law of friction."""
    slider = rig(rng, (1.5, 4.0))
    assert isinstance(slider.law, st.ExponentialWeakening)
    mu_0, mu_inf, v_f = slider.law.mu_0, slider.law.mu_inf, slider.law.v_f
    load, V = slider.normal_load, slider.motion.velocity
    bristles = slider.k_x / load * 10 ** rng.uniform(1.5, 3.0)
    damping = rng.uniform(0.0, 1.0) * 2.0 * sqrt(bristles * slider.mass / load)
    slip = 0.01 * mu_0 * load / slider.k_x
    law = (
        slider.law,
        st.laws.Stribeck(mu_0, mu_inf, v_f),
        st.laws.RateStateAgeing(
            a=0.01, b=rng.uniform(0.02, 0.05), D_c=slip, mu_star=mu_0, V_star=V
        ),
        st.laws.LuGre(mu_inf, mu_0, v_f, bristles, damping),
        st.Coulomb(mu_inf, mu_static=mu_0),
    )[rng.choice(5, p=[0.4, 0.2, 0.15, 0.1, 0.15])]
    still = isinstance(law, st.Coulomb) and rng.random() < 0.5
    return slider.replace(friction=law, **({"phi": "0 deg"} if still else {}))


def record_of(run: st.Trajectory, rng: Generator) -> tuple[st.Record, float]:
    """Return the record of a run, and the true zero of its force across."""
    F_0 = run.slider.F_0
    forces = np.stack([run.samples[name] for name in ("spring_x", "spring_y")])
    forces += 10 ** rng.uniform(-4.5, -1.5) * F_0 * rng.standard_normal(forces.shape)
    zero, drift, stated = F_0 * rng.normal(0.0, 0.3), 0.0, rng.random() < 0.5
    time = run.samples["time"]
    if rng.random() < 0.3:
        drift = F_0 * rng.normal(0.0, 0.1) / float(np.ptp(time))
    known = None
    if stated:
        error = F_0 * 10 ** rng.uniform(-4.0, -1.3)
        zero = rng.normal(0.0, error)
        sensor = st.Sensor(zero_uncertainty=error, zero_drift_uncertainty=abs(drift))
        known = {"force_across": sensor}
    forces[1] += zero + drift * (time - time[0])
    if rng.random() < 0.3:
        step = 10 ** rng.uniform(-3.0, -1.5) * F_0
        forces = step * np.round(forces / step)
    return st.Record(time=time, force=forces[0], force_across=forces[1], sensors=known), zero


def look(rng: Generator) -> Judged | None:
    """Return what is said of one rig; None if it does not stick and slip, or nothing is said."""
    slider = slider_of(rng)
    V, F_0 = slider.motion.velocity, slider.F_0
    period = rng.uniform(0.2, 0.8) * F_0 / slider.k_x / V
    duration = F_0 / slider.k_x / V + rng.uniform(2.0, 12.0) * period
    if duration * sqrt(slider.k_y / slider.mass) / (2.0 * pi) > LONGEST_RUN:
        return None
    run = st.simulate(slider, duration, sample_rate=rng.uniform(200.0, 2000.0) / period)
    if not run.status.ok:
        return None
    record, zero = record_of(run, rng)
    analysis = st.analyse(record)
    found = analysis.parts["rotation"]
    if found is None:
        return None
    exact = np.stack([run.samples[name] for name in ("spring_x", "spring_y")])
    path = loadings(record.time, exact, analysis.cycles).mean()
    size = np.hypot(path.x, path.y)
    r_0, r = size[[0, -1]]
    grows = (r - r_0) / (path.x[-1] - path.x[0])
    halves = np.diff(size[[0, HALF, -1]]) / np.diff(path.x[[0, HALF, -1]])
    true, right = UNDETERMINED, found.kind == UNDETERMINED
    for kind, low, high in (
        (TURNING, -np.inf, SOME_GROWTH),
        (BOTH, SOME_GROWTH, MOST_GROWTH),
        (GROWING, MOST_GROWTH, np.inf),
    ):
        true = kind if low <= grows < high else true
        right |= found.kind == kind and low - NEAR < grows < high + NEAR
    if halves.min() < SOME_GROWTH + NEAR and halves.max() > MOST_GROWTH - NEAR:
        right |= found.kind == BOTH  # one after the other
    errors = {}
    if np.isfinite(found.change):
        off = np.abs(np.abs(found.angle) - np.arctan2(np.abs(path.y[[0, -1]]), path.x[[0, -1]]))
        errors["change"] = abs(found.change - r / r_0 + 1.0) / found.change_error
        errors["first angle"], errors["last angle"] = off / found.angle_error
    if np.isfinite(found.F_0) and type(slider.law) in SPEEDS:
        errors["F_0"] = abs(found.F_0 - F_0) / found.F_0_error
    if found.kind == TURNING and not found.stated:
        errors["zero"] = abs(found.zero - zero) / found.zero_error
    return Judged(true, found.kind, right, errors)
