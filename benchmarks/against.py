"""``python -m benchmarks.against REVISION``: is the paper's run slower than it was?

Both versions run in processes of their own, in turn, so that a noisy machine treats them
alike; the statement is the ratio of their times. Exit status 1 if it exceeds the limit.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from statistics import median

ROOT = Path(__file__).parent.parent
WORKER = """
import sys, time
import stiction as st
slider = st.presets.nakano_popov_2020()
st.simulate(slider, 1e-3)
for _ in sys.stdin:
    start = time.perf_counter()
    st.simulate(slider, 5.0)
    print(time.perf_counter() - start, flush=True)
"""


def main() -> int:
    """Time this tree against a revision of it, and say how they compare."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.against", description=__doc__)
    parser.add_argument("revision", nargs="?", default="main", help="git revision (default main)")
    parser.add_argument("--rounds", type=int, default=60, help="runs of each (default 60)")
    parser.add_argument("--limit", type=float, default=1.10, help="ratio allowed (default 1.10)")
    options = parser.parse_args()
    with checked_out(options.revision) as then:
        now, before = alternately((ROOT / "src", then / "src"), options.rounds)
    ratio = median(a / b for a, b in zip(now, before, strict=True))
    print(f"Fig. 3 over 5 s, {options.rounds} runs of each in turn, median (fastest):")
    for name, times in (("this tree", now), (options.revision, before)):
        print(f"  {name}: {1e3 * median(times):.2f} ms ({1e3 * min(times):.2f} ms)")
    print(f"  ratio, median over pairs: {ratio:.3f} (limit {options.limit})")
    return 0 if ratio <= options.limit else 1


@contextmanager
def checked_out(revision: str) -> Iterator[Path]:
    """Check a revision out beside this tree, for as long as it is needed."""
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder) / "tree"
        subprocess.run(
            ["git", "worktree", "add", "--quiet", "--detach", tree, revision], cwd=ROOT, check=True
        )
        try:
            yield tree
        finally:
            subprocess.run(["git", "worktree", "remove", "--force", tree], cwd=ROOT, check=True)


def alternately(sources: Sequence[Path], rounds: int) -> list[list[float]]:
    """Return the times (s) of runs from each source folder, taken in turn."""
    workers = [
        subprocess.Popen(
            [sys.executable, "-c", WORKER],
            env=os.environ | {"PYTHONPATH": str(source)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        for source in sources
    ]
    times: list[list[float]] = [[] for _ in workers]
    for _ in range(rounds + 1):
        for worker, own in zip(workers, times, strict=True):
            assert worker.stdin is not None
            assert worker.stdout is not None
            print(file=worker.stdin, flush=True)
            own.append(float(worker.stdout.readline()))
    for worker in workers:
        worker.communicate()
    return [own[1:] for own in times]  # the first one warms up


if __name__ == "__main__":
    sys.exit(main())
