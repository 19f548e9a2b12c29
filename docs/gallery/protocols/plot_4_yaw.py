"""
Apparent friction against the yaw angle
=======================================

One law, one load: what the load cell reads depends on how the spring is turned. The gap between
its peak and its mean is a "static friction" that the law does not have.
"""

from tempfile import mkdtemp

import stiction as st

base = st.Description.of(st.presets.nakano_popov_2020(), "10 s")
study = st.protocols.yaw_sweep(base, [f"{phi} deg" for phi in (0.5, 1, 2, 3, 4, 6, 8, 10, 12)])
store = mkdtemp() + "/yaw.zarr"
st.sweep(study, store)
found = st.analysis.apparent_friction(st.open_study(store), base.slider)
st.plotting.plot_apparent_friction(found)
