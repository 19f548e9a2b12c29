"""The engine of all cores: threads of this process, and processes beside it if the work is long.

Threads solve side by side, but only one at a time runs Python, which is a third to a half of a run
of a study. Processes do not wait for each other, but take a second to start. Nothing depends on
them: what one of them cannot do, because it has died or does not know a law that was defined in a
notebook, is done here.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import suppress
from queue import Empty, SimpleQueue
from threading import Lock, Thread, Timer
from typing import Any, Generic, NamedTuple, TypeVar

from stiction.machine import CORES, largest_object, python
from stiction.study.execution.engines import Work, in_threads, never

T = TypeVar("T")
LONG = 2.0  # s, twice what a process takes to start: work that ends sooner gains nothing from one
A_PROCESS = 250e6  # bytes: Python, the packages, the compiled solver, and a block of runs
READY = b"."


class Cores(NamedTuple):
    """Threads of this process, and processes beside it if the work takes long.

    Parameters
    ----------
    workers : int
        Number of tasks at a time.
    """

    workers: int = CORES

    def results(self, work: Work[T], tasks: Iterable[int]) -> Iterator[T]:
        """Yield the outcome of each task."""
        helpers = Helpers(work, min(self.workers - 1, int(largest_object() / A_PROCESS)))
        yield from in_threads(self.workers, helpers.do, tasks, helpers.end)


class Helpers(Generic[T]):
    """Processes that do the same work, and start if it takes long."""

    def __init__(self, work: Work[T], count: int) -> None:
        """Start them later."""
        self._work, self._count = work, count
        self._idle: SimpleQueue[subprocess.Popen[bytes]] = SimpleQueue()
        self._started: list[subprocess.Popen[bytes]] = []
        self._ended, self._lock = False, Lock()
        self._timer = Timer(LONG, self._start_all)
        self._timer.daemon = True
        self._timer.start()

    def do(self, task: int, unwanted: Callable[[], bool]) -> T:
        """Do a task in an idle process, or else here."""
        try:
            helper = self._idle.get_nowait()
        except Empty:
            return self._work(task, unwanted)
        try:
            done: T = ask(helper, task)
        except Exception:  # whatever it was, it comes again here, where it can be told
            helper.kill()
            if unwanted():
                raise CancelledError from None
            return self._work(task, unwanted)
        self._idle.put(helper)
        return done

    def end(self) -> None:
        """End the processes, and with them the tasks that they do."""
        self._timer.cancel()
        with self._lock:
            self._ended = True
        for helper in self._started:
            with suppress(OSError), helper:  # closes its pipes
                helper.kill()

    def _start_all(self) -> None:
        try:
            message = pickle.dumps(sys.path) + pickle.dumps(self._work)
        except Exception:  # a law may have anything in it
            return
        for _ in range(self._count):
            Thread(target=self._start, args=(message,), daemon=True).start()

    def _start(self, message: bytes) -> None:
        """Start a process, and wait until it is ready."""
        with suppress(OSError, ValueError):  # its pipes may be closed meanwhile, by `end`
            with self._lock:
                if self._ended:
                    return
                helper = python(__name__, stdout=subprocess.PIPE)
                self._started.append(helper)
            assert helper.stdin is not None
            assert helper.stdout is not None
            helper.stdin.write(message)
            helper.stdin.flush()
            if helper.stdout.read(len(READY)) == READY:
                self._idle.put(helper)


def ask(helper: subprocess.Popen[bytes], task: int) -> Any:
    """Return what another process answers to a task."""
    assert helper.stdin is not None
    assert helper.stdout is not None
    pickle.dump(task, helper.stdin)
    helper.stdin.flush()
    return pickle.load(helper.stdout)


def main() -> None:
    """Do the tasks named on standard input, until it ends."""
    questions, answers = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a law prints is not an answer
    sys.path[:] = pickle.load(questions)
    work = pickle.load(questions)
    answers.write(READY)
    answers.flush()
    with suppress(EOFError, BrokenPipeError):
        while True:
            pickle.dump(work(pickle.load(questions), never), answers)
            answers.flush()


if __name__ == "__main__":
    main()
