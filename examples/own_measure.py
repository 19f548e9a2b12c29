"""A sweep that keeps measures of one's own (see mymeasures.py), beside a built-in one."""

from mymeasures import friction_heat, longest_stick

import stiction as st

slider = st.presets.nakano_popov_2020()
study = st.Study(
    base=st.Description.of(slider, "2 s"),
    axes={"phi": st.Grid("1 deg", "3 deg", 3)},
    measures=["peak_force", friction_heat, longest_stick],
)
print(st.sweep(study, "own-measures.zarr"))
with st.open_study("own-measures.zarr") as data:
    print((1e3 * data["friction_heat"]).round(3).values, "mW")
    print((1e3 * data["longest_stick"]).round(3).values, "ms")
