"""
What a record says about its rig
================================

A record of a rig whose truth is known, with noise and with friction that differs from cycle to
cycle; the priors that a description states; and the posterior of a fit. The force along the drive
knows the misalignment within half a degree.
"""

import numpy as np

import stiction as st
from stiction.inference.simulated.jitter import Jitter, move

TEXT = """
[slider]
mass = "80 g"
k_x = "2.3 +- 0.1 kN/m"
k_y = "0.9 MN/m"
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
rig = st.Rig.from_toml(TEXT)
draw = np.random.default_rng(7)
truth = rig.slider.replace(phi="2.5 deg")
motion = move(truth, np.arange(0.0, 13.0, 0.01), Jitter(0.005, 0.5), draw, cycle=1.4)
force = truth.k_x * motion.rows[:, 0] + 0.004 * draw.standard_normal(len(motion.time))
record = st.Record(time=motion.time, force=force, drive_velocity="0.5 mm/s", normal_load="4 N")
fit = st.fit(record, rig, simulations=400, library="libraries")  # 4000 by default
st.plotting.plot_posterior(fit)
st.plotting.plot_corner(fit)
st.plotting.plot_ranks(fit)
