"""
Creep that diverges before the slip
===================================

Mean velocity of the mass over the time to slip, each cycle a line, and Eq. (7) of the paper. What
looks like stick is creep that accelerates as one over the root of the time left.
"""

import stiction as st

slider = st.presets.nakano_popov_2020()
run = st.simulate(slider, "20 s", sample_rate="2 kHz")
found = st.analysis.find_cycles(st.analysis.record_of(run))
curves = st.analysis.creep_curves(run, found)
st.plotting.plot_creep(curves, st.analysis.mean_creep(curves), slider.motion.velocity)
