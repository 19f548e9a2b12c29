"""
Which parameter matters? A Sobol study
======================================

Sixty-four rigs that fill the space of misalignment, velocity and load evenly, and the period of
their stick-slip.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt

import stiction as st

base = st.Description(st.presets.nakano_popov_2020(), st.Initial(), st.Settings(duration="10 s"))
study = st.Study(
    base=base,
    axes={
        "phi": st.Sobol("0.5 deg", "5 deg", 64),
        "drive.velocity": st.Sobol("0.5 mm/s", "3 mm/s", 64),
        "normal_load": st.Sobol("5 N", "15 N", 64),
    },
    measures=["period"],
)
store = mkdtemp() + "/sobol.zarr"
st.sweep(study, store)
data = st.open_study(store)
figure, axes = plt.subplots(1, 3, figsize=(7, 2.6), sharey=True, layout="constrained")
shown = {"phi": ("φ (deg)", lambda phi: phi), "drive.velocity": ("V (mm/s)", lambda v: 1e3 * v)}
shown["normal_load"] = ("W (N)", lambda w: w)
for ax, (name, (label, unit)) in zip(axes, shown.items(), strict=True):
    ax.plot(unit(data[name]), data["period"], "o", markersize=3)
    ax.set_xlabel(label)
axes[0].set_ylabel("period (s)")
