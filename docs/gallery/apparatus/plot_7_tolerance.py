"""
How well must a rig be aligned?
===============================

A pin-on-plate rig whose misalignment is known to half a degree only: what that does to the
coefficients that it reads, and below which angle the error of the static one stays under 2 %.
"""

import stiction as st

slider = st.presets.nakano_popov_2020()
rig = st.Rig.from_toml(slider.to_toml().replace('phi = "1 deg"', 'phi = "1 +- 0.5 deg"'))
found = st.audit(rig)
axes = st.plotting.plot_tolerance(found.budget)
