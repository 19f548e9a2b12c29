"""
One number decides: A
=====================

Fig. 5 of the paper. The damping ratio of the slow motion is A sin³θ. θ falls towards φ, from
90 deg at first and from 54 deg after each slip. At φ = 1 deg the path crosses ζ = 1 and the mass
slips; at 10 deg it does not.
"""

import matplotlib.pyplot as plt
import numpy as np

import stiction as st

figure, ax = plt.subplots(figsize=(5, 4), layout="constrained")
st.plotting.plot_damping(ax=ax)
for phi, colour in ((1.0, "#D55E00"), (10.0, "#0072B2")):
    s = st.presets.nakano_popov_2020().replace(phi=f"{phi} deg")
    A = st.theory.damping_number_of(s, s.motion.velocity)
    ax.plot([A, A], [90.0, np.degrees(s.phi)], color=colour, linewidth=2.5)
    ax.text(1.1 * A, 2.0 * phi, f"{phi:g} deg", color=colour)
