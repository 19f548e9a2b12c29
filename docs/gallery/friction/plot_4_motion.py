"""
One apparatus under every law
=============================

The force that a load cell reads, from rest, on the paper's apparatus under each law, which is made
comparable as in `stiction compare`. Some stick and slip, others come to slide steadily.
"""

import matplotlib.pyplot as plt

import stiction as st
from stiction.friction import LAWS, has_state

base = st.Description.of(st.presets.nakano_popov_2020(), "5 s", sample_rate="500 Hz")
runs = st.compare(base, [name for name in LAWS if name != "exponential-weakening"])
grain = st.laws.Anisotropic(law=base.slider.law, ratio=1.5)
runs["with a grain"] = st.run(base._replace(slider=base.slider.replace(friction=grain)))
figure, axes = plt.subplots(5, 3, figsize=(7, 6), sharex=True, sharey=True, layout="constrained")
for ax, (name, run) in zip(axes.flat, runs.items(), strict=True):
    colour = "#D55E00" if has_state(run.slider.law) else "#0072B2"
    ax.plot(run.samples["time"], run.samples["spring_x"], color=colour, linewidth=0.9)
    ax.set_title(name, fontsize=8)
figure.supxlabel("time (s)", fontsize=9)
figure.supylabel("force along the drive (N)", fontsize=9)
