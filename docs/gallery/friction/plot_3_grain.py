"""
A surface with a grain
======================

Friction twice as large across the grain as along it: the limit is an ellipse, drawn grey, and the
force need not point against the slip. The tip of the force, for three directions of the grain.
"""

import matplotlib.pyplot as plt
import numpy as np

import stiction as st

figure, axes = plt.subplots(1, 3, figsize=(7.5, 2.8), sharex=True, sharey=True)
turn = np.linspace(0.0, 2.0 * np.pi, 181)
for ax, angle in zip(axes, (0, 45, 90), strict=True):
    law = st.laws.Anisotropic(law=st.Coulomb(mu_0=0.2), ratio=2.0, angle=f"{angle} deg")
    slider = st.presets.nakano_popov_2020().replace(friction=law)
    limit = slider.F_0 * np.exp(1j * np.radians(angle)) * (np.cos(turn) + 2j * np.sin(turn))
    ax.plot(limit.real, limit.imag, color="0.7", linewidth=1.0)
    run = st.simulate(slider, "6 s", sample_rate="1 kHz")
    theta, force = np.radians(run.samples["theta"]), run.samples["friction"]
    ax.plot(force * np.cos(theta), force * np.sin(theta), ".", markersize=3)
    ax.set(title=f"grain at {angle} deg", xlabel="$F_x$ (N)", aspect="equal")
axes[0].set_ylabel("$F_y$ (N)")
figure.tight_layout()
