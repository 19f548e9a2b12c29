"""
Friction laws over slip speed
=============================

Set-valued laws with the parameters that they have in the published systems of `stiction presets`.
"""

import matplotlib.pyplot as plt
import numpy as np

import stiction as st

p = st.presets
sliders = {
    "exponential (Nakano & Popov)": p.nakano_popov_2020(),
    "two exponentials (rosin)": p.rosin_two_exponentials().slider,
    "power law (rosin)": p.rosin_power_law().slider,
    "hyperbolic (rosin)": p.rosin_hyperbolic().slider,
}
figure, ax = plt.subplots(figsize=(5.5, 3.6), layout="constrained")
speed = np.geomspace(1e-5, 1.0, 200)
for name, slider in sliders.items():
    law = slider.friction
    ax.semilogx(1e3 * speed, [law.coefficient(v) / law.coefficient(0.0) for v in speed], label=name)
ax.set(xlabel="slip speed (mm/s)", ylabel="friction over its value at rest")
ax.legend()
