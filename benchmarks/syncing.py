"""``python -m benchmarks.syncing``: the cost of making a study safe against power cuts.

A study of 10 000 runs is done with and without waiting for the disk, in turn, in a folder inside
the present one. Compared are the medians of the wall times, and of the processor's, which tell the
work of syncing on a busy machine, too. Exit status 1 if a study takes more than 3 % longer.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from contextlib import contextmanager
from pathlib import Path
from statistics import median
from time import perf_counter, process_time
from typing import TYPE_CHECKING, NamedTuple
from unittest.mock import patch

import stiction as st
from stiction.study.execution.engines import Threads

if TYPE_CHECKING:
    from collections.abc import Iterator

SIDE = 100  # runs along phi and along V
BAR = 0.03  # of the time without syncing
CORES = os.cpu_count() or 1


def study(side: int) -> st.Study:
    """Return the paper's run over 5 s, at other angles and speeds."""
    base = st.Description(st.presets.nakano_popov_2020(), st.Initial(), st.Settings(duration=5.0))
    axes = {
        "phi": st.Grid("0.5 deg", "10 deg", side),
        "drive.velocity": st.Grid("0.1 mm/s", "10 mm/s", side, "log"),
    }
    return st.Study(base=base, axes=axes)


@contextmanager
def syncing(wanted: bool) -> Iterator[None]:
    """Have files synced to the disk, or not."""
    if wanted:
        yield
        return
    with patch("os.fsync", lambda handle: None):
        yield


class Times(NamedTuple):
    """How long a study takes, in s."""

    wall: float
    processor: float


def time_study(side: int, synced: bool) -> Times:
    """Do a study."""
    os.sync()  # what others left to write is no part of it
    with tempfile.TemporaryDirectory(dir=Path.cwd()) as folder, syncing(synced):
        wall, processor = perf_counter(), process_time()
        st.sweep(study(side), Path(folder) / "a.zarr", engine=Threads(CORES))
        return Times(perf_counter() - wall, process_time() - processor)


def main() -> int:
    """Do the study in turn with and without; return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.syncing", description=__doc__)
    parser.add_argument("--rounds", type=int, default=5, help="pairs of studies")
    options = parser.parse_args()
    time_study(2, True)  # loads what is compiled
    seen: dict[bool, list[Times]] = {True: [], False: []}
    for number in range(options.rounds):
        for synced in (True, False) if number % 2 else (False, True):
            seen[synced].append(time_study(SIDE, synced))
        print(f"without: {seen[False][-1]}, with: {seen[True][-1]}", flush=True)
    wall, processor = (longer(seen, name) for name in Times._fields)
    print(f"syncing takes {wall:+.1%} of the wall time, {processor:+.1%} of the processor's")
    return 0 if wall < BAR else 1


def longer(seen: dict[bool, list[Times]], name: str) -> float:
    """Return by which part of its time a study takes longer with syncing than without."""
    synced, other = (median(getattr(each, name) for each in seen[kind]) for kind in (True, False))
    return synced / other - 1.0


if __name__ == "__main__":
    sys.exit(main())
