"""
Four laws on one apparatus
==========================

Force, position, slip speed and phase portrait of the paper's apparatus under four kinds of
friction. Rows at the bottom of the third panel are true rest.
"""

import stiction as st

base = st.Description(
    st.presets.nakano_popov_2020(), st.Initial(), st.Settings(duration="5 s", sample_rate="2 kHz")
)
laws = ["coulomb", "lugre", "rate-and-state-ageing"]
st.compare(base, laws).plot()
