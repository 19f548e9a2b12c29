"""
Stacked stages: unequal masses
==============================

Where the x stage rides on the y stage, more mass moves across than along. The slow motion hardly
notices; the transverse oscillation sinks in pitch.
"""

import matplotlib.pyplot as plt

import stiction as st

figure, ax = plt.subplots(figsize=(6, 3.2), layout="constrained")
for heavier in (1, 4, 16):
    slider = st.presets.nakano_popov_2020().replace(mass_y=0.25 * heavier)
    run = st.simulate(slider, "2.1 s", sample_rate="10 kHz")
    found = st.analysis.transverse_oscillation(run)
    ax.plot(found["time"], found["frequency"], label=f"$m_y = {heavier} m_x$")
ax.set(xlabel="time (s)", ylabel="frequency (Hz)")
ax.legend()
