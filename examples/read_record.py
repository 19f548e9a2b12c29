"""A record from a file: what is guessed, what must be said, and what it says of its apparatus.

Here the file is made of a simulated run, as an instrument with a decimal comma would write it; the
mass that is stated is four times too large.
"""

import tempfile
from pathlib import Path

import stiction as st

run = st.simulate(st.presets.nakano_popov_2020(), duration=10.0, sample_rate=10e3)
cell = st.Sensor(noise="5 mN", quantisation="1 mN", filter="800 Hz")
made = st.measure(run, cell, sample_rate="2 kHz")

path = Path(tempfile.mkdtemp()) / "data.csv"
rows = (f"{1e3 * t:.1f};{1e3 * f:.1f}" for t, f in zip(made.time, made.force, strict=True))
path.write_text(
    "Test of May\nRecipe: 10 N, 1 mm/s\nZeit;Kraft\n" + "\n".join(rows).replace(".", ",")
)

try:
    st.read_record(path)
except st.StictionError as error:
    print(error)  # no units: which?

record = st.read_record(
    path,
    time="ms",
    force="mN",
    normal_load="10 N",
    stiffness="1 N/mm",
    drive_velocity="1 mm/s",
    mass="1 kg",  # it is 250 g
    stiffness_across="10 N/um",
)
print(record.origin)
print(record.sensors["force"])  # noise and quantisation, estimated

found = st.analyse(record)
for warning in found.warnings:
    print(warning)
print(found.tables()[-1])  # what the record says of its apparatus
