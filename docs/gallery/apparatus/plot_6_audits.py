"""
How much of the static friction is the rig?
===========================================

Three published rigs and what an audit predicts that their load cells read: the law's coefficient
at rest, and the apparent static and kinetic ones.
"""

import matplotlib.pyplot as plt
import numpy as np

import stiction as st

rigs = {
    "pin on plate": st.presets.nakano_popov_2020(),
    "constant law": st.presets.nakano_popov_constant().slider,
    "rosin on steel": st.presets.rosin_two_exponentials().slider,
}
figure, ax = plt.subplots(figsize=(5.5, 3.2), layout="constrained")
place = np.arange(len(rigs))
peak, mean = [], []
rest = [slider.law.coefficient(0.0) for slider in rigs.values()]
for slider in rigs.values():
    run = st.simulate(slider, "20 s", sample_rate="1 kHz")
    late = run.samples["mu"][run.samples["time"] > 10.0]
    peak.append(late.max())
    mean.append(late.mean())
ax.plot(place, rest, "k_", markersize=50, label="the law at rest")
ax.bar(place - 0.2, peak, 0.4, label="peak: apparent static")
ax.bar(place + 0.2, mean, 0.4, label="mean: apparent kinetic")
ax.set_xticks(place, list(rigs))
ax.set_ylabel("force over load")
ax.legend(loc="lower left")
