"""What a benchmark run found: rows, ratios and where it ran."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from statistics import median
from typing import NamedTuple

from .accuracy import Accuracy, as_accurate
from .ours import SOLVER

PACKAGES = ("stiction", "numba", "numpy", "scipy", "xarray", "numbalsoda")


class Row(NamedTuple):
    """A solver with its settings, its wall times (s) and its accuracy; `note` says why not."""

    solver: str
    settings: str
    times: Sequence[float] = ()
    accuracy: Accuracy | None = None
    note: str = ""

    @property
    def median(self) -> float:
        """Median wall time in s."""
        return median(self.times)


class Ratio(NamedTuple):
    """How many times longer a peer takes than our fastest row that is at least as accurate."""

    peer: Row
    ours: Row
    ratio: float


def ratios(rows: Sequence[Row]) -> list[Ratio]:
    """Return the ratio for each peer that some row of ours matches in accuracy."""
    done = [(row, row.accuracy) for row in rows if row.times and row.accuracy is not None]
    own = [(row, found) for row, found in done if row.solver == SOLVER]
    found_ratios = []
    for peer, error in done:
        matching = [row for row, found in own if as_accurate(found, error)]
        if peer.solver != SOLVER and matching:
            fastest = min(matching, key=lambda row: row.median)
            found_ratios.append(Ratio(peer, fastest, peer.median / fastest.median))
    return found_ratios


def environment() -> dict[str, str]:
    """Return the versions of what was timed and the kind of machine it ran on."""
    found = {"python": platform.python_version(), "processor": _processor()}
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "not installed"
    return found


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()
