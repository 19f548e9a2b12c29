"""
A measured record with hum
==========================

A sawtooth with periods and drops that scatter, noise, and a mains hum of half the drop. The
analysis finds the slips and no others, and says what it has subtracted.
"""

import numpy as np

import stiction as st

draw = np.random.default_rng(2)
time = np.arange(0.0, 20.0, 1e-3)
slips = np.cumsum(1.0 + 0.05 * draw.standard_normal(25))
low = np.concatenate([[0.0], 0.5 + 0.05 * draw.standard_normal(25)])
last = np.searchsorted(slips, time)
start = np.concatenate([[0.0], slips])[last]
force = low[last] + 1.0 * (time - start)
force += 0.25 * np.sin(2 * np.pi * 50.0 * time) + 0.01 * draw.standard_normal(len(time))
record = st.Record(time=time, force=force, stiffness="1 kN/m", drive_velocity="1 mm/s")
st.analyse(record).plot()
