"""
Leine's block on a belt, and two smoothings
===========================================

The published benchmark of stick-slip, with its friction set-valued and with the two
regularisations that other programs use. The smoothed blocks creep where the true one rests.
"""

import matplotlib.pyplot as plt
import numpy as np

import stiction as st

figure, ax = plt.subplots(figsize=(6, 3.4), layout="constrained")
presets = {"set-valued": st.presets.leine_belt, "arctan": st.presets.leine_arctan}
for name, preset in {**presets, "LuGre": st.presets.leine_lugre}.items():
    run = st.run(preset())
    late = run.samples["time"] > run.samples["time"][-1] - 30.0
    time, u = run.samples["time"][late], run.samples["u_x"][late]
    start = time[np.argmin(u[: len(u) // 2])]  # all curves begin at a trough
    ax.plot(time - start, u, label=name, linewidth=1.2)
ax.set(xlabel="time (s)", ylabel="elongation (m)")
ax.set_xlim(0.0, 16.0)
ax.legend()
