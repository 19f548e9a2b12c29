"""Start-up: the waiting times of a user, from an empty machine to a figure."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from time import perf_counter

from rich.progress import Progress

from benchmarks.section import Cell, Section, Table

ROOT = Path(__file__).parent.parent
ROUNDS = 5
HEADINGS = ("what", "fastest (s)", "median (s)", "runs")
NOTES = (
    "Each in a process of its own, from its start to its end.",
    "First run: nothing is compiled yet; later ones load what the first has left on disk. Their"
    " difference is what one law with one kind of drive takes to compile; each pays it once.",
)
COLD_NOTE = (
    "Cold: new environment, empty caches of packages and of compiled code; the download depends on"
    " the connection."
)
RUN = "import stiction as st; st.simulate(st.presets.nakano_popov_2020(), 5.0, sample_rate=0)"


class Failed(RuntimeError):
    """A command did not do what it should; the message says which and why."""


def run(progress: Progress, quick: bool) -> Section:
    """Return import times, first and later runs, and a cold start from the installation on."""
    rounds = 2 if quick else ROUNDS
    task = progress.add_task("start-up", total=None)
    with tempfile.TemporaryDirectory() as folder:
        empty = {"NUMBA_CACHE_DIR": folder}
        first = time_command([sys.executable, "-c", RUN], empty)
        later = [time_command([sys.executable, "-c", RUN], empty) for _ in range(rounds)]
    rows = [
        _row(
            "python -c pass", [time_command([sys.executable, "-c", "pass"]) for _ in range(rounds)]
        )
    ]
    for what, command in _commands().items():
        rows.append(_row(what, [time_command(command) for _ in range(rounds)]))
    rows += [_row("first run of Fig. 3", [first]), _row("later ones", later)]
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


def _commands() -> dict[str, list[str]]:
    """Return what is started, in words and as it is called."""
    python = [sys.executable, "-c"]
    command = [*python, "from stiction.cli import main; main(['--help'])"]
    return {
        "import stiction": [*python, "import stiction"],
        "import all that a run needs": [*python, "from stiction import Slider, simulate"],
        "stiction --help": command,
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
        figure = [stiction, "paper", "--figure", "3", "--out", str(place / "paper")]
        steps = {
            "new environment": time_command(make, caches),
            "install, packages downloaded": time_command(install, caches),
            "first figure, stiction paper --figure 3": time_command(figure, caches),
        }
        again = time_command(figure, caches)
    rows: list[tuple[Cell, ...]] = [*steps.items()]
    return [*rows, ("from nothing to a figure", sum(steps.values())), ("the figure again", again)]


def time_command(command: Sequence[str], changes: Mapping[str, str] | None = None) -> float:
    """Return how long a command takes (s), with some variables of the environment changed.

    Raises
    ------
    Failed
        If it fails.
    """
    begin = perf_counter()
    done = subprocess.run(
        command, env=os.environ | (changes or {}), capture_output=True, text=True, cwd=ROOT
    )
    time = perf_counter() - begin
    if done.returncode != 0:
        last = (done.stderr.strip() or "no message").splitlines()[-1]
        raise Failed(f"{Path(command[0]).name} {command[1]}: {last}")
    return time


def _row(what: str, times: Sequence[float]) -> tuple[Cell, ...]:
    middle = sorted(times)[len(times) // 2]
    return what, min(times), middle, len(times)
