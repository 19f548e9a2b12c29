"""
Modes over the misalignment
===========================

Growth rate and frequency of all modes of steady sliding. Where a growth rate crosses zero, a
vibration begins; here at 8.66 deg.
"""

import stiction as st

st.stability(st.presets.nakano_popov_2020(), over="phi", between=("1 deg", "20 deg")).plot()
