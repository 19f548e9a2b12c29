"""
The friction vector turns in its circle
=======================================

The tip of the friction force over the first 2.2 seconds. It runs along the circle of radius μ₀W
from across the drive to along it. Inside the circle it lies while the mass rests, as in the first
11 ms, and in the slip, where friction is weaker.
"""

import matplotlib.pyplot as plt
import numpy as np

import stiction as st

slider = st.presets.nakano_popov_2020()
run = st.simulate(slider, "2.2 s", sample_rate="4 kHz")
psi, force = np.radians(run.samples["psi"]), run.samples["friction"]

figure, ax = plt.subplots(figsize=(4.6, 4), layout="constrained")
turn = np.linspace(0.0, 2.0 * np.pi, 361)
ax.plot(slider.F_0 * np.cos(turn), slider.F_0 * np.sin(turn), color="0.7", linewidth=1.0)
points = ax.scatter(
    force * np.cos(psi), force * np.sin(psi), c=run.samples["time"], s=3, cmap="cividis"
)
figure.colorbar(points, label="time (s)")
ax.set(xlabel="along the drive (N)", ylabel="across (N)", aspect="equal")
ax.set(xlim=(-0.6, 2.2), ylim=(-1.2, 2.2))
