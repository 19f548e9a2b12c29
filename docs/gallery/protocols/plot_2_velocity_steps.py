"""
Velocity steps: a, b and D_c
============================

Each step of the drive gives a jump of a ln(V₂/V₁), and an evolution over the distance D_c, both
rounded by the rig's spring. The fit is that of law and spring together: it finds the parameters
that the law was given.
"""

import stiction as st

law = st.laws.RateStateAgeing(mu_star=0.6, a=0.010, b=0.015, D_c="10 um", V_star="1 um/s")
test = st.protocols.velocity_steps(["1 um/s", "10 um/s", "1 um/s"], distance="0.2 mm")
slider = st.Slider(
    mass="1 g",
    k_x="1 MN/m",
    k_y="100 MN/m",
    phi="0 deg",
    normal_load="10 N",
    friction=law,
    drive=test,
)
run = st.simulate(slider, sample_rate="20 Hz")
st.plotting.plot_velocity_steps(st.analysis.velocity_steps(run))
