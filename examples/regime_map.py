"""A map of stick-slip, vibration and steady sliding: a study over two parameters.

Writes regime_map.zarr, which xarray.open_zarr reads, and regime_map.png. Stopped and started
again, it computes the missing runs.
"""

import stiction as st

base = st.Description.of(st.presets.nakano_popov_2020(), "6 s")
study = st.Study(
    base=base,
    axes={
        "phi": st.Grid("1 deg", "12 deg", 12),
        "drive.velocity": st.Grid("0.6 mm/s", "20 mm/s", 8, spacing="log"),
    },
    measures=["regime", "peak_force", "period"],
)
print(st.sweep(study, "regime_map.zarr"))
st.map("regime_map.zarr").plot()[0].figure.savefig("regime_map.png")

changes = st.refine(study, "regime_map.zarr", "phi", "0.01 deg", apart=["settling"])
for V, phi in zip(changes["drive.velocity"].values, changes["phi"].values, strict=True):
    print(f"at V = {1e3 * V:6.3f} mm/s it comes to rest from phi = {phi:.2f} deg on")
