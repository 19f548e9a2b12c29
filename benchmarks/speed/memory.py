"""The memory of a run, each in a process of its own."""

from __future__ import annotations

import subprocess
import sys
from importlib.util import find_spec

from rich.progress import Progress

from benchmarks.section import Cell, Table

DURATIONS = (5.0, 500.0)  # s
RATES = (None, 1e3)  # 1/s
WORKER = """
import sys
import stiction as st
from benchmarks.speed.peak import peak

duration, rate = float(sys.argv[1]), float(sys.argv[2])
slider = st.presets.nakano_popov_2020()
st.simulate(slider, 1e-2, sample_rate=1e3)
before = peak()
run = st.simulate(slider, duration, sample_rate=rate)
print(before, peak() - before, run.data.nbytes)
"""
HEADINGS = ("duration (s)", "samples (1/s)", "before (MB)", "growth (MB)", "result (MB)")


def table(progress: Progress, quick: bool) -> Table:
    """Return by how much a run makes its process grow, and how large its result is."""
    title = "Memory"
    if find_spec("resource") is None:
        return Table(f"{title}: not measured, this system does not count it", HEADINGS, [])
    durations = DURATIONS[:1] if quick else DURATIONS
    task = progress.add_task("memory", total=len(durations) * len(RATES))
    rows: list[tuple[Cell, ...]] = []
    for duration in durations:
        for rate in RATES:
            command = [sys.executable, "-c", WORKER, str(duration), str(rate or 0.0)]
            said = subprocess.run(command, check=True, capture_output=True, text=True).stdout
            megabytes = [int(word) / 1e6 for word in said.split()]
            rows.append((f"{duration:g}", "none" if rate is None else f"{rate:g}", *megabytes))
            progress.advance(task)
    return Table(title, HEADINGS, rows)
