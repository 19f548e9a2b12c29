"""Start-up: the waiting times of a user, from an empty machine to a figure."""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

from rich.progress import Progress

from benchmarks.section import Cell, Section, Table

ROOT = Path(__file__).parents[2]
ROUNDS = 5
HEADINGS = ("what", "fastest (s)", "median (s)", "least processor time (s)", "runs")
NOTES = (
    "Each in a process of its own, from its start to its end.",
    "First run: nothing is compiled yet; later ones load what the first has left on disk. Their"
    " difference is what one law with one kind of drive takes to compile; each pays it once. By"
    " default a second process compiles the map of cycles meanwhile.",
    "Commands are of the paper's apparatus, with all that they load on disk. On a machine that"
    " others use, processor time says more: that of all threads, and of the system for them.",
)
COLD_NOTE = (
    "Cold: new environment, empty caches of packages and of compiled code; the download depends on"
    " the connection."
)
WITHOUT_BYTECODE = "PYTHONDONTWRITEBYTECODE"  # twice the time for what users have compiled
STICTION = (sys.executable, "-m", "stiction")
RUN = "import stiction as st; st.simulate(st.presets.nakano_popov_2020(), 5.0, sample_rate=0)"
IN_STEPS = RUN.replace("sample_rate=0", "sample_rate=0, multiscale=False")


class Took(NamedTuple):
    """The time that passed, and that of the processor for a process and all that it started, s."""

    wall: float
    processor: float


class Failed(RuntimeError):
    """A command did not do what it should; the message says which and why."""


def run(progress: Progress, quick: bool) -> Section:
    """Return import times, first and later runs, and a cold start from the installation on."""
    rounds = 2 if quick else ROUNDS
    task = progress.add_task("start-up", total=None)
    with tempfile.TemporaryDirectory() as folder:
        bare = {"NUMBA_CACHE_DIR": str(Path(folder) / "bare")}
        in_steps = time_command([sys.executable, "-c", IN_STEPS], bare)
        empty = {"NUMBA_CACHE_DIR": folder}
        first = time_command([sys.executable, "-c", RUN], empty)
        later = [time_command([sys.executable, "-c", RUN], empty) for _ in range(rounds)]
        rows = [
            _row(what, [time_command(command) for _ in range(rounds)])
            for what, command in _imports().items()
        ]
        rows += [
            _row("first run of Fig. 3 in steps", [in_steps]),
            _row("first run of Fig. 3", [first]),
            _row("later ones", later),
        ]
        for what, command in _commands(Path(folder)).items():
            time_command(command, empty)  # compiles
            rows.append(_row(what, [time_command(command, empty) for _ in range(rounds)]))
    tables, notes = [Table("Fresh processes", HEADINGS, rows)], [*NOTES]
    if quick:
        notes.append("Cold start: left out, for speed.")
    else:
        progress.update(task, description="cold start")
        try:
            tables.append(Table("Cold start", ("what", "time (s)"), cold()))
            notes.append(COLD_NOTE)
        except Failed as reason:
            notes.append(f"Cold start: not measured: {reason}")
    progress.update(task, total=1, completed=1)
    return Section("Start-up", tables, notes)


def _imports() -> dict[str, list[str]]:
    """Return what is started before there is work, in words and as it is called."""
    python = [sys.executable, "-c"]
    return {
        "python -c pass": [*python, "pass"],
        "import stiction": [*python, "import stiction"],
        "import all that a run needs": [*python, "from stiction import Slider, simulate"],
        "stiction --help": [*STICTION, "--help"],
    }


def _commands(folder: Path) -> dict[str, list[str]]:
    """Return the commands for which people wait most, in words and as they are called."""
    rig, result = str(folder / "my.toml"), str(folder / "my.nc")
    time_command([*STICTION, "init", rig])
    return {
        "stiction run": [*STICTION, "run", rig, "-o", result],
        "stiction audit": [*STICTION, "audit", rig],
        "stiction audit -o": [*STICTION, "audit", rig, "-o", str(folder / "my.html")],
        "stiction analyse": [*STICTION, "analyse", result],
        "stiction plot": [*STICTION, "plot", result, "-o", str(folder / "my.png")],
        "stiction paper": [*STICTION, "paper", "-o", str(folder / "paper")],
    }


def cold() -> list[tuple[Cell, ...]]:
    """Return the times of an installation into a new environment and of a first figure there.

    Raises
    ------
    Failed
        If there is no uv, or it cannot install.
    """
    uv = shutil.which("uv")
    if uv is None:
        raise Failed("uv is not installed")
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        caches = {
            "UV_CACHE_DIR": str(place / "packages"),
            "NUMBA_CACHE_DIR": str(place / "compiled"),
            "MPLCONFIGDIR": str(place / "fonts"),
        }
        environment = place / "environment"
        programs = environment / ("Scripts" if os.name == "nt" else "bin")
        python, stiction = str(programs / "python"), str(programs / "stiction")
        make = [uv, "venv", "--python", sys.executable, str(environment)]
        install = [uv, "pip", "install", "--compile-bytecode", "--python", python, str(ROOT)]
        figure = [stiction, "paper", "--figure", "3", "-o", str(place / "paper")]
        steps = {
            "new environment": time_command(make, caches).wall,
            "install, packages downloaded": time_command(install, caches).wall,
            "first figure, stiction paper --figure 3": time_command(figure, caches).wall,
        }
        again = time_command(figure, caches).wall
    rows: list[tuple[Cell, ...]] = [*steps.items()]
    return [*rows, ("from nothing to a figure", sum(steps.values())), ("the figure again", again)]


def time_command(command: Sequence[str], changes: Mapping[str, str] | None = None) -> Took:
    """Return how long a command takes, with some variables of the environment changed.

    Raises
    ------
    Failed
        If it fails.
    """
    begin, before = perf_counter(), _processor_time()
    own = {name: value for name, value in os.environ.items() if name != WITHOUT_BYTECODE}
    done = subprocess.run(
        command, env=own | dict(changes or {}), capture_output=True, text=True, cwd=ROOT
    )
    took = Took(perf_counter() - begin, _processor_time() - before)
    if done.returncode != 0:
        last = (done.stderr.strip() or "no message").splitlines()[-1]
        raise Failed(f"{Path(command[0]).name} {command[1]}: {last}")
    return took


def _processor_time() -> float:
    """Return the processor time of all processes that this one has started, and that ended, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _row(what: str, took: Sequence[Took]) -> tuple[Cell, ...]:
    wall = sorted(each.wall for each in took)
    least = min(each.processor for each in took)
    return what, wall[0], wall[len(wall) // 2], least, len(took)
