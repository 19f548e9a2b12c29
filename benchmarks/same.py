"""``python -m benchmarks.same [REVISION]``: results of this tree against a revision's, bit by bit.

210 runs over all laws, programs and modes are made in both trees. Who moves or renames code changes
none. Exit status 1 if one differs, 2 if there is nothing to compare.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from pathlib import Path

from rich.console import Console
from rich.progress import track

from benchmarks.regression.results import runs
from benchmarks.regression.trees import ROOT, is_revision, laid_out

RESULTS = Path(__file__).parent / "regression" / "results.py"


def main() -> int:
    """Compare the results of this tree and of a revision."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.same", description=__doc__)
    parser.add_argument("revision", nargs="?", default="main", help="git revision (default main)")
    revision = parser.parse_args().revision
    console = Console()
    if not is_revision(revision):
        console.print(f"git knows no revision {revision!r}; name a branch, tag or commit")
        return 2
    with laid_out(revision) as then:
        before = _start(then)
        now = _start(ROOT / "src")
        pairs = zip(now.stdout, before.stdout, strict=True)
        count = sum(1 for _ in runs())
        other = [a for a, b in track(pairs, "runs", total=count, console=console) if a != b]
    if now.wait() or before.wait():
        console.print("a process ended with an error; its message is above")
        return 1
    for line in other:
        console.print(f"differs: {line.split(chr(9))[0]}")
    console.print(f"{count - len(other)} of {count} runs are the same to the last bit")
    return 1 if other else 0


def _start(source: Path) -> subprocess.Popen[str]:
    command = [sys.executable, str(RESULTS)]
    env = os.environ | {"PYTHONPATH": str(source)}
    return subprocess.Popen(command, env=env, stdout=subprocess.PIPE, text=True)


if __name__ == "__main__":
    sys.exit(main())
