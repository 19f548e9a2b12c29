"""
Four laws on one apparatus
==========================

Force, position, slip speed and phase portrait of the paper's apparatus under four kinds of
friction. The rows at the bottom are the share of time at true rest.
"""

import stiction as st

base = st.Description.of(st.presets.nakano_popov_2020(), "5 s", sample_rate="20 kHz")
laws = ["coulomb", "lugre", "rate-and-state-ageing"]
st.compare(base, laws).plot()
