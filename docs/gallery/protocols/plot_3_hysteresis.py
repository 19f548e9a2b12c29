"""
Reversal loops
==============

A drive that goes back and forth: the area of a loop is the work of friction, its width the travel
less what the spring takes up.
"""

import stiction as st

test = st.protocols.reversal_loops("1 mm/s", "10 mm")
slider = st.presets.nakano_popov_2020().replace(friction=st.Coulomb(mu_0=0.2), drive=test)
run = st.simulate(slider, sample_rate="200 Hz")
st.plotting.plot_hysteresis(st.analysis.hysteresis(run))
