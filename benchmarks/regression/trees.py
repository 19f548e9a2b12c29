"""Two trees side by side: a revision laid out beside this one, and a timing process in each."""

from __future__ import annotations

import io
import os
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
WORKLOAD = Path(__file__).parent / "workload.py"


class Absent(LookupError):
    """A tree does not know what a case needs."""


def differs(revision: str) -> bool:
    """Return whether `src` is other than in a revision, with what is not committed."""
    differs = ["git", "diff", "--quiet", revision, "--", "src"]
    new = ["git", "ls-files", "--others", "--exclude-standard", "src"]
    if subprocess.run(differs, cwd=ROOT).returncode != 0:
        return True
    return bool(subprocess.run(new, cwd=ROOT, check=True, capture_output=True).stdout)


def is_revision(revision: str) -> bool:
    """Return whether git knows a revision."""
    command = ["git", "rev-parse", "--quiet", "--verify", f"{revision}^{{commit}}"]
    return subprocess.run(command, cwd=ROOT, capture_output=True).returncode == 0


@contextmanager
def laid_out(revision: str) -> Iterator[Path]:
    """Lay out the sources of a revision, for as long as they are needed."""
    command = ["git", "archive", "--format=tar", revision, "src"]
    archive = subprocess.run(command, cwd=ROOT, check=True, capture_output=True).stdout
    with tempfile.TemporaryDirectory() as folder:
        with tarfile.open(fileobj=io.BytesIO(archive)) as tar:
            tar.extractall(folder, filter="data")
        yield Path(folder) / "src"


class Worker:
    """A process that times cases in one tree."""

    def __init__(self, source: Path) -> None:
        """Start it in the tree whose `src` this is."""
        self.process = subprocess.Popen(
            [sys.executable, WORKLOAD],
            env=os.environ | {"PYTHONPATH": str(source)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def ask(self, case: str) -> None:
        """Have a case run."""
        print(case, file=self.process.stdin, flush=True)

    def answer(self) -> float:
        """Return how long it took (s).

        Raises
        ------
        Absent
            If this tree does not know what the case needs.
        """
        line = self.process.stdout.readline().strip()
        if line.startswith("absent"):
            raise Absent(line.removeprefix("absent "))
        if not line:
            raise RuntimeError("a timing process ended; its message is above")
        return float(line)

    def close(self) -> None:
        """End the process."""
        self.process.communicate()


@contextmanager
def at_work(*sources: Path) -> Iterator[list[Worker]]:
    """Start a worker in each tree, and end them."""
    workers = [Worker(source) for source in sources]
    try:
        yield workers
    finally:
        for worker in workers:
            worker.close()
