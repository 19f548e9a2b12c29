"""
What looks like stick and slip
==============================

Fig. 3 of the paper. The force along the drive is a sawtooth, as from any friction test. Across the
drive the force jumps to the full friction at first, to four fifths of it after each slip, and falls
to zero. The magnitude of friction does not change until the slip: the force turns.
"""

import matplotlib.pyplot as plt

import stiction as st

run = st.simulate(st.presets.nakano_popov_2020(), "5 s", sample_rate="2 kHz")
time = run.samples["time"]

figure, axes = plt.subplots(5, 1, figsize=(6, 7), sharex=True, layout="constrained")
rows = {
    "spring_x": ("$k_x u_x$ (N)", 1.0),
    "spring_y": ("$k_y u_y$ (N)", 1.0),
    "friction": ("$F$ (N)", 1.0),
    "psi": (r"$\psi$ (deg)", 1.0),
    "X": ("$X$ (mm)", 1e3),
}
for ax, (name, (label, scale)) in zip(axes, rows.items(), strict=True):
    ax.plot(time, scale * run.samples[name], linewidth=0.8)
    ax.set_ylabel(label)
axes[-1].set_xlabel("time (s)")
figure.suptitle("One degree of misalignment")
