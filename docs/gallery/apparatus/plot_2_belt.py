"""
Leine's block on a belt, and two smoothings
===========================================

The published benchmark of stick-slip, with its friction set-valued and with the two
regularisations that other programs use. All three forces look alike. Only the set-valued block
rests, where its slip speed leaves the figure; the others creep.
"""

import matplotlib.pyplot as plt
import numpy as np

import stiction as st

presets = {"set-valued": st.presets.leine_belt, "arctan": st.presets.leine_arctan}
presets["LuGre"] = st.presets.leine_lugre
figure, axes = plt.subplots(2, 1, figsize=(6, 4.6), sharex=True, layout="constrained")
for name, preset in presets.items():
    run = st.run(preset())
    late = run.samples["time"] > run.samples["time"][-1] - 30.0
    time, u = run.samples["time"][late], run.samples["u_x"][late]
    speed = run.samples["slip_speed"][late]
    time = time - time[np.argmin(u[: len(u) // 2])]  # all curves begin at a trough
    axes[0].plot(time, u, label=name, linewidth=1.2)
    axes[1].semilogy(time, np.where(speed > 0.0, speed, np.nan), linewidth=1.2)
axes[0].set(ylabel="elongation (m)", xlim=(0.0, 16.0), ylim=(-0.7, 1.6))
axes[1].set(xlabel="time (s)", ylabel="slip speed (m/s)", ylim=(1e-7, 10.0))
axes[0].legend(loc="upper center", ncols=3)
