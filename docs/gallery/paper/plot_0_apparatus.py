"""
The apparatus from above
========================

Figs. 1 and 2 of the paper. A mass is pulled over a plane by a spring that is soft along one axis,
stiff across it, and turned by φ against the drive. The friction force need not point along the
drive; in the course of a test it turns.
"""

import stiction as st

st.plotting.plot_slider(st.presets.nakano_popov_2020())
