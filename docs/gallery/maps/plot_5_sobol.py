"""
Which parameter matters? A Sobol study
======================================

Sixty-four rigs that fill the space of misalignment, velocity and load evenly, and the period of
their stick-slip. Above each panel stands the rank correlation: load and velocity decide, the
misalignment hardly matters.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
from matplotlib.ticker import NullFormatter
from scipy.stats import spearmanr

import stiction as st

base = st.Description.of(st.presets.nakano_popov_2020(), "10 s")
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
period = data["period"].values
figure, axes = plt.subplots(1, 3, figsize=(7, 2.8), sharey=True, layout="constrained")
shown = {"phi": ("φ (deg)", 1), "drive.velocity": ("V (mm/s)", 1e3), "normal_load": ("W (N)", 1)}
for ax, (name, (label, unit)) in zip(axes, shown.items(), strict=True):
    ax.semilogy(unit * data[name].values, period, "o", markersize=3.5)
    rank = spearmanr(data[name], period, nan_policy="omit").statistic
    ax.set(xlabel=label, title=f"rank correlation {rank:+.2f}", yticks=[0.2, 0.5, 1, 2])
axes[0].set(ylabel="period (s)", yticklabels=["0.2", "0.5", "1", "2"])
axes[0].yaxis.set_minor_formatter(NullFormatter())
