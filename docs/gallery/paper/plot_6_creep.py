"""
Creep that diverges before the slip
===================================

Mean velocity of the mass before the first slip, beside Eq. (7) of the paper and both forms of
Eq. (8). What looks like stick is creep that accelerates as one over the root of the time left. As
it is printed, Eq. (8) gives half of it after 1 s.
"""

import matplotlib.pyplot as plt
import numpy as np

import stiction as st

slider = st.presets.nakano_popov_2020()
run = st.simulate(slider, "2.03 s", sample_rate="10 kHz")
V, l_x = slider.motion.velocity, slider.F_0 / slider.k_x
time = np.linspace(0.02, 1.99, 400)
whole = np.exp(np.linspace(np.log(2.03 - 0.02), np.log(0.01), 60))  # times to slip, seen evenly
start = 2.03 - whole
X = np.interp(start, run.samples["time"], run.samples["X"])
figure, ax = plt.subplots(figsize=(5.5, 3.6), layout="constrained")
ax.loglog(2.03 - (start[1:] + start[:-1]) / 2, np.diff(X) / np.diff(start), "k.", label="simulated")
laws = {
    "Eq. (7)": st.theory.creep_velocity,
    "Eq. (8), corrected": st.theory.creep_velocity_approximation,
    "Eq. (8), as printed": st.theory.creep_velocity_as_printed,
}
for (name, formula), style in zip(laws.items(), ("-", "--", ":"), strict=True):
    ax.loglog(2.03 - time, formula(time, V, slider.phi, l_x), style, label=name)
ax.set(xlabel="time to slip (s)", ylabel="creep velocity (m/s)")
ax.set(xlim=(2.1, 0.03), ylim=(2e-7, 1e-3))
ax.legend()
