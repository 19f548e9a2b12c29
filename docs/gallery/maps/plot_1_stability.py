"""
Where steady sliding is stable
==============================

The boundary in the plane of misalignment and drive velocity, followed as a curve, not scanned. The
point is the paper's apparatus.
"""

import stiction as st

st.stability(st.presets.nakano_popov_2020(), over=("phi", "drive.velocity")).plot()
