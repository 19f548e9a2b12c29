"""Studies: their speed against the bare kernel's, on one core and on all, and their memory.

Each measurement is a process of its own.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from importlib.util import find_spec
from typing import Any

from rich.progress import Progress

from benchmarks.section import Cell, Section, Table

CORES = os.cpu_count() or 1
SIDE, QUICK_SIDE = 40, 8  # runs along phi and along V
ROUNDS = 2
PLANNED = (10**4, 10**6)

COMMON = """
import json, os, sys, tempfile
from pathlib import Path
from time import perf_counter
import stiction as st
from stiction.study.execution.cores import Cores
from stiction.study.execution.engines import Threads
from stiction.study.variables.observed_run import observe_run
from stiction.study.variables import observed_run
from benchmarks.speed.peak import peak

def study(side, other, duration):
    settings = st.Settings(duration=duration)
    base = st.Description(st.presets.nakano_popov_2020(), st.Initial(), settings)
    axes = {"phi": st.Grid("0.5 deg", "10 deg", side),
            "drive.velocity": st.Grid("0.1 mm/s", "10 mm/s", other, "log")}
    return st.Study(base=base, axes=axes)

def processor():  # of this process and of those that it has started
    return sum(os.times()[:4])

def timed(work):
    wall, before = perf_counter(), processor()
    work()
    print(json.dumps({"seconds": perf_counter() - wall, "processor": processor() - before,
                      "memory": 1e-6 * peak()}))

with tempfile.TemporaryDirectory() as folder:  # imports what is needed, loads the kernel
    st.sweep(study(2, 2, 0.01), Path(folder) / "a.zarr")
"""
SWEEP = (
    COMMON
    + """
side, cores = int(sys.argv[1]), int(sys.argv[2])
made = study(side, side, 5.0)
with tempfile.TemporaryDirectory() as folder:
    timed(lambda: st.sweep(made, Path(folder) / "a.zarr", engine=Cores(cores)))
"""
)
KERNEL = (
    COMMON
    + """
from concurrent.futures import ThreadPoolExecutor
side, threads = int(sys.argv[1]), int(sys.argv[2])
made = study(side, side, 5.0)
asked = []

def note(description, times, progress=None, room=None):
    asked.append((description, times))
    raise st.StictionError

observed_run.solve_coarsely = note
for index in ((i, j) for i in range(side) for j in range(side)):
    try:
        observe_run(made.description(index), None)
    except st.StictionError:
        pass
from stiction.simulation import solve_coarsely
with ThreadPoolExecutor(threads) as pool:
    timed(lambda: list(pool.map(lambda each: solve_coarsely(*each).code, asked)))
"""
)
PLAN = (
    COMMON
    + """
side, other = int(sys.argv[1]), int(sys.argv[2])
made = study(side, other, 1e-4)
def enough(tally):
    if tally.seconds > 2.0:
        raise KeyboardInterrupt
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "a.zarr"
    begin = perf_counter()
    before = 1e-6 * peak()
    try:
        st.sweep(made, path, engine=Threads(1), progress=enough)
    except KeyboardInterrupt:
        pass
    metadata = sum(file.stat().st_size for file in path.rglob("zarr.json"))
    done = (st.open_study(path)["status"].values >= 0).sum()
    print(json.dumps({"tasks": made.layout.tasks, "metadata": metadata, "before": before,
                      "memory": 1e-6 * peak(), "done": int(done)}))
"""
)
HEADINGS = (
    "",
    "cores",
    "wall time (s)",
    "processor time a run (ms)",
    "share of the kernel's speed",
    "peak memory (MB)",
)
NOTES = (
    "Fig. 3's system for 5 s at each point of a grid of phi from 0.5 to 10 deg and V from 0.1 to "
    f"10 mm/s; the best of {ROUNDS}, taken in turn, after a study of four runs. The kernel: "
    "the solver alone, for the same descriptions at the same sample times, made before. A study: "
    "descriptions, measures, store, on threads, and beside them on processes after two seconds; "
    "their memory is not in the table. The share is that of processor time.",
    "Planned: a store is made for so many runs of 0.1 ms of motion, and 2 s of them done.",
)


def run(progress: Progress, quick: bool) -> Section:
    """Return what a study costs beside its runs, and how its memory grows with them."""
    if find_spec("resource") is None:
        return Section("Studies", (), ("not measured: this system does not count memory",))
    side = QUICK_SIDE if quick else SIDE
    threads = sorted({1, CORES})
    scripts = {"kernel": KERNEL, "study": SWEEP}
    cases = [(name, script, n) for n in threads for name, script in scripts.items()]
    rounds = 1 if quick else ROUNDS
    task = progress.add_task("studies", total=len(cases) * rounds + len(PLANNED))
    found: dict[tuple[str, int], list[dict[str, Any]]] = {}
    for _ in range(rounds):
        for name, script, n in cases:
            found.setdefault((name, n), []).append(output_of(script, side, n))
            progress.advance(task)
    rows: list[tuple[Cell, ...]] = []
    for (name, n), each in found.items():
        took = least(each, "processor")
        share = least(found["kernel", n], "processor") / took
        memory = max(one["memory"] for one in each)
        row = (name, n, least(each, "seconds"), 1e3 * took / side**2, share, round(memory))
        rows.append(row)
    notes = [f"On {CORES} cores a study is {ratio(found):.3g} times as fast as on one.", *NOTES]
    planned = [plan(runs, progress, task) for runs in PLANNED]
    headings = ("runs planned", "tasks", "metadata (bytes)", "memory before (MB)", "after (MB)")
    return Section(
        "Studies",
        (Table(f"{side**2} runs", HEADINGS, rows), Table("Planned", headings, planned)),
        notes,
    )


def ratio(found: dict[tuple[str, int], list[dict[str, Any]]]) -> float:
    """Return how many times faster a study is on all cores than on one."""
    return least(found["study", 1], "seconds") / least(found["study", CORES], "seconds")


def least(found: list[dict[str, Any]], what: str) -> float:
    """Return the smallest of the same measurement, repeated."""
    return min(float(each[what]) for each in found)


def plan(runs: int, progress: Progress, task: Any) -> tuple[Cell, ...]:
    """Return the row of a study that is planned and begun."""
    made = output_of(PLAN, 100, runs // 100)
    progress.advance(task)
    memory = (round(made[when]) for when in ("before", "memory"))
    return f"{runs:.0e}", made["tasks"], made["metadata"], *memory


def output_of(script: str, *arguments: int) -> dict[str, Any]:
    """Return what a script prints, run in a process of its own."""
    command = [sys.executable, "-c", script, *map(str, arguments)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    result: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return result
