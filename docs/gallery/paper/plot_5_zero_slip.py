"""
True rest, up to a thousand times a second
==========================================

At zero slip friction holds whatever it must, up to μ₀W. Solved exactly, the mass of Fig. 3 rests
once in each transverse oscillation, until 0.17 s before a slip. The shaded intervals are true rest;
their ends are known to rounding.
"""

import matplotlib.pyplot as plt

import stiction as st

run = st.simulate(st.presets.nakano_popov_2020(), "1.005 s", sample_rate="1 MHz")
late = run.samples["time"] > 1.0
time, speed = 1e3 * run.samples["time"][late], 1e3 * run.samples["slip_speed"][late]

figure, ax = plt.subplots(figsize=(6, 3), layout="constrained")
ax.plot(time, speed, linewidth=1.0)
for begin, end in 1e3 * run.stick_intervals:
    if end > time[0]:
        ax.axvspan(begin, end, color="#E69F00", alpha=0.4, linewidth=0)
ax.set(xlabel="time (ms)", ylabel="slip speed (mm/s)", xlim=(time[0], time[-1]))
ax.set_title("shaded: at rest")
