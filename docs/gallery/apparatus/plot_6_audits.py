"""
How much of the static friction is the rig?
===========================================

Three published rigs, and the test of each that `stiction audit` simulates: the largest force and
the mean force that a load cell reads, over the friction of the law at rest. A large peak may be
inertia, a small mean is slip; neither is the contact's.
"""

import matplotlib.pyplot as plt
import numpy as np

import stiction as st

rigs = {
    "pin on plate\n(Nakano & Popov)": st.presets.nakano_popov_2020(),
    "block on a belt\n(Leine et al.)": st.presets.leine_belt().slider,
    "rosin on steel\n(two exponentials)": st.presets.rosin_two_exponentials().slider,
}
peak, mean = [], []
for slider in rigs.values():
    record = st.audit(slider).observation.record
    reading = record.force / (slider.law.coefficient(0.0) * slider.normal_load)
    peak.append(reading.max())
    mean.append(reading[len(reading) // 2 :].mean())
figure, ax = plt.subplots(figsize=(5.5, 3.4), layout="constrained")
place = np.arange(len(rigs))
ax.bar(place - 0.18, peak, 0.36, label="peak: apparent static")
ax.bar(place + 0.18, mean, 0.36, label="mean: apparent kinetic")
ax.axhline(1.0, color="black", linewidth=1.0, linestyle="--", label="the law at rest")
ax.set_xticks(place, list(rigs))
ax.set(ylabel="reading over friction at rest", ylim=(0.0, 1.7))
ax.legend(loc="upper left", ncols=2)
