"""
Which test next?
================

The misalignment of a rig is uncertain. For each further test, the width that the posterior is
expected to have, over that of the present test: a channel added, or another normal load.
"""

import stiction as st

TEXT = """
[slider]
mass = "80 g"
k_x = "2.3 kN/m"
k_y = "0.9 MN/m"
phi = {low = "0.5 deg", high = "5 deg", scale = "log"}
normal_load = "4 N"
[friction]
law = "exponential-weakening"
mu_0 = {low = 0.5, high = 0.75}
mu_inf = {low = 0.25, high = 0.5}
v_f = "10 mm/s"
[drive]
velocity = "0.5 mm/s"
"""
rig = st.Rig.from_toml(TEXT)
advice = st.design(rig, of="phi", angles=(), velocities=(), loads=["2 N"], simulations=256)
st.plotting.plot_design(advice)
