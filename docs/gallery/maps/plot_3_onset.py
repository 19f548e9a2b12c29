"""
A hard onset, with hysteresis
=============================

The amplitude of the vibration, swept up and down through the boundary of stability of a belt. Two
motions exist at one velocity: which one is seen depends on the past.
"""

import stiction as st

slider = st.presets.veraszto_stepan().slider
onset = st.analysis.find_onset(slider, "drive.velocity", [0.16, 0.18, 0.2, 0.22, 0.24])
st.plotting.plot_onset(onset)
