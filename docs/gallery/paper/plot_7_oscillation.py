"""
Frequency, amplitude and rest of the transverse oscillation
===========================================================

The oscillation followed through four slips: its frequency falls as sin θ towards each of them,
its velocity reaches V sin φ, where the mass comes to rest.
"""

import stiction as st

run = st.simulate(st.presets.nakano_popov_2020(), "5 s", sample_rate="10 kHz")
st.plotting.plot_oscillation(run, st.analysis.transverse_oscillation(run))
