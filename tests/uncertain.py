"""A rig whose description states what is uncertain, and records of it, for fits."""

from __future__ import annotations

import numpy as np

import stiction as st
from stiction.inference.jitter import Jitter, move

TEXT = """
[slider]
mass = "80 g"
k_x = "2.3 +- 0.1 kN/m"
k_y = {value = "0.9 MN/m", uncertainty = "10 %"}
phi = {low = "0.5 deg", high = "5 deg", scale = "log"}
normal_load = "4 N"

[friction]
law = "exponential-weakening"
mu_0 = {low = 0.5, high = 0.75}
mu_inf = {low = 0.25, high = 0.5}
v_f = "10 mm/s"

[drive]
velocity = "0.5 mm/s"
"""

SIMULATIONS = 384  # whole blocks, enough for a fit
BOTH = ("force", "force_across")


def record_of(
    slider: st.Slider, seed: int, duration: float = 13.0, *, drift: float = 0.0, channels=BOTH
) -> st.Record:
    """Return a record of some jittered cycles, with noise of 0.2 % of the friction force."""
    random = np.random.default_rng(seed)
    times = np.arange(0.0, duration, 0.01)
    motion = move(slider, times, Jitter(0.005, 0.5, drift), random, cycle=1.4)
    noise = 0.004 * random.standard_normal((2, len(motion.time)))
    forces = np.array([slider.k_x, slider.k_y]) * motion.rows[:, :2] + noise.T
    measured = dict(zip(BOTH, forces.T, strict=True))
    return st.Record(
        time=motion.time, drive_velocity=0.5e-3, normal_load=4.0,
        **{name: measured[name] for name in channels},
    )  # fmt: skip
