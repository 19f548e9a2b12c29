"""
From order to chaos
===================

The two-state slip law on a spring: at 0.86 of the critical stiffness slips of two sizes take turns,
at 0.8525 no slip is like another. Slip speed over force, for both.
"""

import matplotlib.pyplot as plt

import stiction as st

figure, ax = plt.subplots(figsize=(6, 3.6), layout="constrained")
runs = {
    "chaos": ("0.6", 0.4, st.presets.two_state_chaos()),
    "two sizes in turn": ("#D55E00", 1.6, st.presets.period_doubling()),
}
for name, (colour, width, preset) in runs.items():
    run = st.run(preset)
    half = run.samples["time"] > 0.7 * run.samples["time"][-1]
    speed = 1e6 * run.samples["slip_speed"][half]
    ax.plot(run.samples["mu"][half], speed, color=colour, linewidth=width, label=name)
ax.set(xlabel="spring force over load", ylabel="slip speed (µm/s)", yscale="log")
ax.legend()
