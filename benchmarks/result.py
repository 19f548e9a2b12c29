"""What a benchmark run found, and where it ran."""

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
    """A solver with its settings, its wall times (s) and its accuracy, or a note on why not."""

    solver: str
    settings: str
    times: Sequence[float] = ()
    accuracy: Accuracy | None = None
    note: str = ""

    @property
    def median(self) -> float:
        """Median wall time in s."""
        return median(self.times)


def matched(peer: Row, rows: Sequence[Row]) -> Row | None:
    """Return the fastest row of ours that is at least as accurate as a peer's, if there is one."""
    if peer.accuracy is None or peer.solver == SOLVER:
        return None
    own = [row for row in rows if row.solver == SOLVER and row.times and row.accuracy]
    matching = [row for row in own if as_accurate(row.accuracy, peer.accuracy)]
    return min(matching, key=lambda row: row.median, default=None)


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
