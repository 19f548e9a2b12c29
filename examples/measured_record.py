"""The force from a load cell: kind of motion, cycles, and creep before each slip.

Here the "measurement" is a simulated one with noise and drift; a real one is read with
``time, force = np.loadtxt("record.csv", delimiter=",", skiprows=1).T``.
"""

import numpy as np

import stiction as st

run = st.simulate(st.presets.nakano_popov_2020(), duration=10.0, sample_rate=2e3)
time = run.data["time"].values
noise = 0.02 * np.random.default_rng(1).standard_normal(len(time))
force = run.data["spring_x"].values + noise + 0.05 * time  # N, with drift

record = st.Record(
    time=time,
    force=force,
    normal_load="10 N",
    stiffness="1 N/mm",
    drive_velocity="1 mm/s",
    mass="250 g",
)
for doubt in st.analyse(record).warnings:
    print(doubt)  # it drifts
found = st.analyse(st.analysis.detrend(record))
print(found.regime)
print(f"static friction coefficient {found.friction.static.coefficient:.4f}")
print(found.cycles[["peak_time", "period", "drop", "mu_static", "mu_kinetic"]].to_dataframe())
print(found.summary["mean"].sel(quantity="period").item(), "s is the mean period")
