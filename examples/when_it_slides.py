"""The least misalignment, speed and damping for steady sliding, and the kind of onset."""

import numpy as np

import stiction as st

slider = st.presets.nakano_popov_2020()
print(st.linear_stability.steady_sliding(slider))

phi = st.linear_stability.critical(slider, "phi", between=("0 deg", "45 deg"))
print("critical misalignment (deg):", np.degrees(phi.values).round(4))  # 8.656
damper = st.linear_stability.critical(slider, "c_x", between=("0 N*s/m", "300 N*s/m"))
print("critical damping (N s/m):", damper.values.round(2))

curve = st.linear_stability.boundary(slider, "phi", "drive.velocity")  # followed, not gridded
print(curve.sizes["point"], "points on the boundary in the plane of misalignment and speed")
