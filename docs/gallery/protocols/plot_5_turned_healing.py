"""
Less healing, by a misaligned spring
====================================

In a hold friction turns towards the soft spring. When the drive moves again, it loads the stiff
spring first: friction turns away, and back while the mass creeps and the contacts forget. Left,
from the end of a hold of 1000 s to the largest force; right, the gain of each hold.
"""

import matplotlib.pyplot as plt
import numpy as np

import stiction as st

rock = st.laws.RateStateAgeing(mu_star=0.6, a=0.010, b=0.015, D_c="10 um", V_star="1 um/s")
holds = ["10 s", "30 s", "100 s", "300 s", "1000 s"]
test = st.protocols.slide_hold_slide("10 um/s", holds, slide="60 s")
slider = st.Slider(
    mass="1 g",
    k_x="20 kN/m",  # stretched by 30 D_c
    k_y="2 MN/m",
    phi="0 deg",
    normal_load="10 N",
    friction=rock,
    drive=test,
    cell_angle="0 deg",  # along the drive
)
figure, (path, gain) = plt.subplots(1, 2, figsize=(6.8, 3.0), layout="constrained")
for phi, colour, marker in ((0, "#0072b2", "o"), (2, "#d55e00", "s"), (5, "#000000", "^")):
    run = st.simulate(slider.replace(phi=f"{phi} deg"), sample_rate="20 Hz")
    late = run.data.sel(time=slice(run.data["time"].max() - 60.0, None))  # the last slide
    rise = late.isel(time=slice(int(late["spring_x"].argmax("time")) + 1))
    angle = np.degrees(np.arctan2(rise["spring_y"], rise["spring_x"]))
    path.plot(angle, rise["spring_x"] / 10.0, marker + "-", color=colour, markevery=[-1])
    found = st.analysis.healing(run)
    label = f"{phi} deg: {found.per_decade:.4f} a decade"
    gain.semilogx(found.hold, found.gain, marker + "-", color=colour, label=label)
path.set(xlabel="direction of friction (deg)", ylabel="force along x over the load (1)")
gain.set(xlabel="hold time (s)", ylabel=r"$\Delta\mu$: peak less steady (1)")
figure.legend(loc="outside upper center", ncols=3, fontsize="small")
