"""
Every published number beside the computed one
==============================================

All published systems of `stiction presets`, run and measured. Each point is a number: how far the
computed value lies from the published one, over the tolerance that the publication's digits allow.
"""

import matplotlib.pyplot as plt

import stiction as st
from stiction.presets import PRESETS

figure, ax = plt.subplots(figsize=(6, 6), layout="constrained")
shown = {name: preset for name, preset in PRESETS.items() if preset.published}
for row, preset in enumerate(shown.values()):
    for number in preset.numbers(st.run(preset.make())):
        share = abs(number.deviation) / number.tolerance if number.tolerance else 0.0
        colour = "#0072B2" if number.agrees else "#D55E00"
        ax.plot(max(share, 1e-6), row, "o", color=colour, alpha=0.7, markersize=4)
ax.axvline(1.0, color="black", linewidth=0.8)
ax.set(xscale="log", xlim=(5e-7, 5.0), xlabel="deviation over tolerance (below 1e-6: at the left)")
ax.set_yticks(range(len(shown)), list(shown), fontsize=7)
ax.invert_yaxis()
