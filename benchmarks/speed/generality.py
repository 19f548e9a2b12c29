"""The cost of generality: laws, protocols and stored results beside the plain case, in one run."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import numpy as np
from rich.progress import Progress

import stiction as st
from benchmarks.section import Cell, Table
from stiction.presets import Preset, find

DURATION = 5.0  # s
ROUNDS = 15
PLAIN = "exponential weakening, constant drive"
SPEEDS = np.r_[0.0, np.geomspace(1e-4, 0.1, 30)]  # m/s, of the table
NOTES = (
    f"Generality: all rows in turn, {ROUNDS} rounds; a ratio is the median of those in each round"
    f" to {PLAIN}. The laws are alike (0.20 at rest, 0.15 in fast slip, 10 mm/s), but the motion"
    " differs: compare the times a step, which hold its share of sticks, landings and the call."
    " Laws with internal state have another method, whose steps are larger and cost more.",
    "Three earthquakes: rate and state with inertia, slip speed over six decades in each cycle of"
    " 3778.0755 s, run without samples; the error is that of the last period.",
)


def sliders() -> dict[str, st.Slider]:
    """Return the paper's case under each law, and under drives that come to the same."""
    paper = st.presets.nakano_popov_2020()
    plain = paper.law
    alike = (0.20, 0.15, 0.01)
    laws = {
        "Coulomb, static coefficient": st.Coulomb.like(*alike),
        "Stribeck": st.laws.Stribeck.like(*alike),
        "hyperbolic weakening": st.laws.HyperbolicWeakening.like(*alike),
        "table of 31 points": st.laws.Table(v=SPEEDS, mu=[plain.coefficient(v) for v in SPEEDS]),
        "elliptic surface": st.laws.Anisotropic(plain, 1.5, "30 deg"),
        "LuGre": st.laws.LuGre.like(*alike),
        "rate and state, ageing": st.laws.RateStateAgeing.like(*alike),
    }
    drives = {
        "program of one piece": st.protocols.DriveProgram(
            velocity="1 mm/s", program=[st.protocols.Constant()]
        ),
        "modulated, 1 um/s at 50 Hz": st.protocols.DriveProgram(
            velocity="1 mm/s", along=st.protocols.Modulation("1 um/s", "50 Hz")
        ),
    }
    return {
        PLAIN: paper,
        **{name: paper.replace(friction=law) for name, law in laws.items()},
        **{name: paper.replace(drive=drive) for name, drive in drives.items()},
    }


def tables(progress: Progress, quick: bool) -> tuple[Table, Table, Table]:
    """Return the cost of laws and protocols, of samples and files, and of an earthquake."""
    rounds = 3 if quick else ROUNDS
    known = sliders()
    _compile(progress, list(known))
    calls = {name: _simulation(slider) for name, slider in known.items()}
    took = {name: call().statistics for name, call in calls.items()}
    times = interleave(progress, "laws, protocols", calls, rounds)
    rows: list[tuple[Cell, ...]] = []
    for name, own in times.items():
        steps, sticks = took[name].steps, took[name].stick_count
        whole = _ratio(own, times[PLAIN])
        share = whole * took[PLAIN].steps / steps
        per_step = 1e9 * median(own) / steps
        rows.append((name, 1e3 * median(own), steps, sticks, per_step, share, whole))
    headings = (
        "law or protocol",
        "time (ms)",
        "steps",
        "sticks",
        "ns/step",
        "a step, ratio",
        "run, ratio",
    )
    generality = Table("Cost of generality", headings, rows)
    return generality, _storage(progress, known[PLAIN], rounds), earthquakes(progress, rounds)


def earthquakes(progress: Progress, rounds: int) -> Table:
    """Return the cost and the error of three cycles of the preset `earthquake-cycle`.

    Slip speed spans six decades in each, and the state as many.
    """
    preset = find("earthquake-cycle")
    runs = {f"rtol={rtol:g}": _cycles(preset, rtol) for rtol in (1e-4, 1e-6, 1e-8, 1e-10)}
    st.run(next(iter(runs.values())))  # compiles
    times = interleave(
        progress, "earthquakes", {n: _bare(each) for n, each in runs.items()}, rounds
    )
    rows = []
    for name, own in times.items():
        run = st.run(runs[name])
        period = preset.numbers(run)[1]
        rows.append((name, 1e3 * median(own), run.statistics.steps, period.deviation))
    return Table(
        "Three earthquakes", ("run", "time (ms)", "steps", "error of the period (s)"), rows
    )


def _cycles(preset: Preset, rtol: float) -> st.Description:
    description = preset.make()
    settings = description.run.model_dump(exclude_none=True) | {"rtol": rtol}
    return description._replace(run=st.Settings(**settings))


def _bare(description: st.Description) -> Callable[[], st.Trajectory]:
    """Return the run without samples."""
    settings = description.run.model_dump(exclude_none=True) | {"sample_rate": 0.0}
    bare = description._replace(run=st.Settings(**settings))
    return lambda: st.run(bare)


def interleave(
    progress: Progress, what: str, calls: Mapping[str, Callable[[], Any]], rounds: int
) -> dict[str, list[float]]:
    """Return the times (s) of each call, all in turn, round after round."""
    times: dict[str, list[float]] = {name: [] for name in calls}
    task = progress.add_task(what, total=rounds)
    for _ in range(rounds):
        for name, call in calls.items():
            begin = perf_counter()
            call()
            times[name].append(perf_counter() - begin)
        progress.advance(task)
    return times


def _storage(progress: Progress, slider: st.Slider, rounds: int) -> Table:
    """Return what samples cost, and a file of them."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "run.nc"
        sampled = st.simulate(slider, DURATION, sample_rate=10e3)
        size = sampled.save(file).stat().st_size / 1e6
        calls: dict[str, Callable[[], Any]] = {
            "no samples": _simulation(slider),
            "1 kHz": _simulation(slider, 1e3),
            "10 kHz": _simulation(slider, 10e3),
            "writing 10 kHz": lambda: sampled.save(file),
            "reading it": lambda: st.load(file),
        }
        times = interleave(progress, "samples, files", calls, rounds)
    plain = times["no samples"]
    rows = [
        (name, 1e3 * median(own), _ratio(own, plain), size if "ing" in name else "")
        for name, own in times.items()
    ]
    return Table("Stored results", ("what", "time (ms)", "ratio", "file (MB)"), rows)


def _ratio(times: list[float], plain: list[float]) -> float:
    return median(a / b for a, b in zip(times, plain, strict=True))


def _simulation(slider: st.Slider, rate: float = 0.0) -> Callable[[], st.Trajectory]:
    return lambda: st.simulate(slider, DURATION, sample_rate=rate)


def _compile(progress: Progress, known: Sequence[str]) -> None:
    """Compile for each slider on all cores: what one process compiles is on disk for all."""
    task = progress.add_task("compile", total=len(known))
    with ProcessPoolExecutor(os.cpu_count(), mp_context=get_context("spawn")) as pool:
        for each in as_completed([pool.submit(_once, name) for name in known]):
            each.result()
            progress.advance(task)


def _once(name: str) -> None:
    st.simulate(sliders()[name], 1e-3, sample_rate=0)
