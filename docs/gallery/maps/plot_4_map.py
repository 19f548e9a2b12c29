"""
A map of motions
================

A study over misalignment and drive velocity: 96 runs of six seconds each, with the theory's
boundary laid over what the runs did.
"""

from tempfile import mkdtemp

import stiction as st

base = st.Description.of(st.presets.nakano_popov_2020(), "6 s")
study = st.Study(
    base=base,
    axes={
        "phi": st.Grid("1 deg", "12 deg", 12),
        "drive.velocity": st.Grid("0.6 mm/s", "20 mm/s", 8, spacing="log"),
    },
    measures=["regime"],
)
store = mkdtemp() + "/map.zarr"
st.sweep(study, store)
st.map(store).plot()
