"""How the misalignment angle decides between stick-slip and steady sliding.

Writes misalignment.png: the spring force that a friction test would record.
"""

from matplotlib.figure import Figure

import stiction as st

slider = st.presets.nakano_popov_2020()
figure = Figure(figsize=(5, 4), layout="constrained")
axes = figure.subplots(3, 1, sharex=True, sharey=True)
for ax, phi in zip(axes, ("1 deg", "5 deg", "10 deg"), strict=True):
    run = st.simulate(slider.replace(phi=phi), duration="5 s", sample_rate="2 kHz")
    ax.plot(run.data["time"], run.data["spring_x"], linewidth=0.8)
    ax.set_title(f"misalignment {phi}", fontsize="medium", loc="left")
    ax.set_ylabel("$k_x u_x$ (N)")
    swing = run.data["spring_x"].sel(time=slice(3, None))
    print(f"{phi:>7}: force swings by {float(swing.max() - swing.min()):.3f} N after 3 s")
axes[-1].set_xlabel("time (s)")
figure.savefig("misalignment.png", dpi=200)
