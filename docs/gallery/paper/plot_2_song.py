"""
The song before the slip
========================

Fig. 4 of the paper. While the mass creeps, it vibrates across the drive, at 1 kHz at first.
Towards the slip the pitch falls as sin θ, the dashed line, because the mass then swings along the
friction force alone.
"""

import matplotlib.pyplot as plt

import stiction as st

run = st.simulate(st.presets.nakano_popov_2020(), "2.1 s", sample_rate="10 kHz")
amplitude = st.analysis.spectrogram(run.samples["v_y"], 10e3, width=0.05, step=0.01)
found = st.analysis.transverse_oscillation(run)

figure, ax = plt.subplots(figsize=(6, 3.6), layout="constrained")
st.plotting.plot_spectrogram(amplitude, highest=1500.0, ax=ax)
ax.plot(found["time"], 1e-3 * found["expected"], "k--", linewidth=1.0)  # kHz
