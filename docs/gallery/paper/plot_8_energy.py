"""
Where the work goes
===================

The work of the drive in each fifth of a second, against what friction dissipates and what springs
and mass store. The residual lies below the bound that is computed beside it.
"""

import numpy as np

import stiction as st

run = st.simulate(st.presets.nakano_popov_2020(), "5 s", sample_rate="2 kHz")
st.plotting.plot_energy(st.analysis.energy_budget(run, np.linspace(0.0, 5.0, 26)))
