"""Our own solver in threads: compiled code runs without Python's lock."""

from __future__ import annotations

from benchmarks.ensembles.many import in_threads
from benchmarks.harness.contestant import Contestant, rows
from benchmarks.precision.peers.ours import solve

RTOL = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)


def contestants() -> list[Contestant]:
    """Return our rows: every cycle solved in steps, and most of them by the return map."""
    return [
        *rows("stiction, threads", in_threads(solve), [{"rtol": rtol} for rtol in RTOL]),
        *rows(
            "stiction, multiscale, threads",
            in_threads(solve),
            [{"rtol": rtol, "multiscale": True} for rtol in RTOL],
        ),
    ]
