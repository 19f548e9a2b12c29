"""A library in a process of its own: one that hangs or crashes takes nothing else with it."""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.harness.contestant import Failed

ROOT = Path(__file__).parents[2]
START = 120.0  # s; for imports and for what is compiled
BRIEF = 1e-6  # of the duration; a run that compiles what the real one needs


class Library:
    """The contestants of a module, running in a process that lives as long as it behaves.

    Parameters
    ----------
    module : str
        What has the function ``contestants()``.
    name : str
        As printed if it is missing.
    interpreter : str, optional
        The Python that has it; the one that runs when left out.
    limit : float
        Seconds that a run may take.
    """

    def __init__(self, module: str, name: str, interpreter: str | None = None, limit: float = 60.0):
        """Start the process."""
        self.module, self.name, self.limit = module, name, limit
        self.interpreter = interpreter or sys.executable
        self.process: subprocess.Popen[bytes] | None = None
        self.start()

    def start(self) -> None:
        """Start the process; what it says first is not waited for."""
        self.ready: set[tuple[int, int]] = set()  # what is compiled, by row and points
        self.known: list[tuple[str, str]] | None = None
        path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
        with contextlib.suppress(FileNotFoundError):  # no such interpreter: nothing installed
            self.process = subprocess.Popen(
                [self.interpreter, "-m", "benchmarks.harness.worker", self.module],
                env=os.environ | {"PYTHONPATH": path},
                cwd=ROOT,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                bufsize=0,
            )

    def rows(self) -> list[tuple[str, str]]:
        """Return solver and settings of each row; several contests may ask.

        Raises
        ------
        Failed
            If it is not installed or does not start.
        """
        if self.known is not None:
            return self.known
        if self.process is None:
            raise Failed(f"not installed: there is no {self.interpreter}")
        answer = self._answer(START)
        if "missing" in answer:
            raise Failed(f"not installed: {answer['missing']}")
        if "failed" in answer:
            raise Failed(f"does not start: {answer['failed']}")
        self.known = [(solver, settings) for solver, settings in answer["rows"]]
        return self.known

    def solve(self, row: int, duration: float, points: int) -> tuple[float, NDArray[np.float64]]:
        """Return the time a row takes (s) and its elongations; raise `Failed`."""
        with tempfile.TemporaryDirectory() as folder:
            into = str(Path(folder) / "elongation.npy")
            seconds = self.measure(row, duration, points, into)
            return seconds, np.load(into)

    def measure(self, row: int, duration: float, points: int = 2, into: str | None = None) -> float:
        """Return the time a row takes, s, compiled before; raise `Failed`."""
        if self.process is None:
            self.start()
            self.rows()
        if (row, points) not in self.ready:
            self._request(START, row, duration * BRIEF, points, None)
            self.ready.add((row, points))
        return self._request(self.limit, row, duration, points, into)

    def _request(
        self, limit: float, row: int, duration: float, points: int, into: str | None
    ) -> float:
        assert self.process is not None
        assert self.process.stdin is not None
        request = {"row": row, "duration": duration, "points": points, "into": into}
        with contextlib.suppress(BrokenPipeError):  # it has ended: the answer will say so
            self.process.stdin.write(json.dumps(request).encode() + b"\n")
        answer = self._answer(limit)
        if "failed" in answer:
            raise Failed(answer["failed"])
        return float(answer["seconds"])

    def _answer(self, limit: float) -> dict[str, Any]:
        """Wait for the next line; a process that has none to say is ended."""
        assert self.process is not None
        assert self.process.stdout is not None
        if not select.select([self.process.stdout], [], [], limit)[0]:
            self.end()
            return {"failed": f"no result within {limit:.0f} s"}
        line = self.process.stdout.readline()
        if line:
            return dict(json.loads(line))
        code = self.process.wait()
        self.end()
        name = signal.Signals(-code).name if code < 0 else f"exit status {code}"
        return {"failed": f"crashed ({name})"}

    def end(self) -> None:
        """End the process, if it runs."""
        if self.process is not None:
            self.process.kill()
            self.process.communicate()
            self.process = None
