"""A stage that stutters: the force on the load cell, from the stage's recorded position."""

from pathlib import Path

import numpy as np

import stiction as st

time = np.linspace(0.0, 2.0, 401)  # s
position = 1.0 * time + 0.01 * np.sin(2 * np.pi * 8.0 * time)  # mm: 1 mm/s, and 8 Hz on top
table = np.column_stack([time, position])
Path("stage.csv").write_text("time [s],position [mm]\n", encoding="utf-8")
with Path("stage.csv").open("a", encoding="utf-8") as file:
    np.savetxt(file, table, delimiter=",", fmt="%.9f")

stage = st.protocols.DriveProgram(program=[st.protocols.read_recorded("stage.csv")])
for drive in (st.ConstantVelocity("1 mm/s"), stage):
    slider = st.presets.nakano_popov_2020().replace(drive=drive)
    run = st.simulate(slider, duration="2 s", sample_rate="2 kHz")
    force = run.data["spring_x"].sel(time=slice(1.0, 2.0))
    name = type(drive).__name__
    print(f"{name}: force {float(force.mean()):.4f} N, {float(force.std()):.4f} N about it")
