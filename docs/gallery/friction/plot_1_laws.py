"""
All laws at a glance
====================

The coefficient of steady sliding over slip speed, of each law that is built in. Their ``like``
makes them comparable. Most fall by 0.05, two thirds of it up to 10 mm/s. Power-law weakening and
LuGre's hyperbolic law fall towards zero, from the same slope at rest; rate and state by 0.0125
a decade; Coulomb friction does not fall. Blue laws are set-valued at zero slip; orange ones have
internal states.
"""

import matplotlib.pyplot as plt
import numpy as np

import stiction as st
from stiction.friction import LAWS, has_state

speeds = np.geomspace(1e-5, 1.0, 121)
figure, axes = plt.subplots(3, 5, figsize=(7.5, 4.6), sharex=True, sharey=True)
for ax, (name, kind) in zip(axes.flat, LAWS.items(), strict=False):
    law = kind.like(0.20, 0.15, 0.01)  # at rest, in rapid slip, most of the fall up to 10 mm/s
    colour = "#D55E00" if has_state(law) else "#0072B2"
    ax.semilogx(1e3 * speeds, [law.coefficient(v) for v in speeds], color=colour)
    ax.set_title(name, fontsize=7.5)
grain = st.laws.Anisotropic(law=st.Coulomb(mu_0=0.2), ratio=1.5)
angle = np.linspace(0.0, 2.0 * np.pi, 100)
axes[-1, -1].remove()
last = figure.add_subplot(3, 5, 15, aspect="equal")
last.plot(0.2 * np.cos(angle), grain.ratio * 0.2 * np.sin(angle), color="#0072B2")
last.set_title("any of them, with a grain", fontsize=7.5)
last.set(xticks=[-0.2, 0.2], yticks=[-0.3, 0.3])
figure.supxlabel("slip speed (mm/s)", fontsize=9)
figure.supylabel("friction coefficient", fontsize=9)
axes[0, 0].set(xticks=[1e-2, 1.0, 1e2], ylim=(0.0, 0.26))
figure.tight_layout(w_pad=0.3)
