"""Engines, which do tasks in parallel and return their outcomes."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from itertools import islice
from typing import NamedTuple, Protocol, TypeVar

from stiction.machine import CORES
from stiction.study.plan.layout import AHEAD

T = TypeVar("T")
PATIENCE = 0.2  # s; on some systems a thread that waits for ever cannot be interrupted

# does a task; its second argument returns whether the task is no longer wanted
Work = Callable[[int, Callable[[], bool]], T]


class Engine(Protocol):
    """The interface of engines."""

    def results(self, work: Work[T], tasks: Iterable[int]) -> Iterator[T]:
        """Yield the outcome of each task in any order, with few tasks in flight.

        Closing the iterator, or an error, drops the tasks in flight.
        """


class Threads(NamedTuple):
    """Threads of this process; the solver runs outside Python's lock.

    Parameters
    ----------
    workers : int
        Number of threads.
    """

    workers: int = CORES

    def results(self, work: Work[T], tasks: Iterable[int]) -> Iterator[T]:
        """Yield the outcome of each task."""
        unwanted = threading.Event()
        waiting = iter(tasks)
        with ThreadPoolExecutor(self.workers, "study") as pool:

            def handed_out(count: int) -> set[Future[T]]:
                return {pool.submit(work, task, unwanted.is_set) for task in islice(waiting, count)}

            try:
                flying = handed_out(AHEAD * self.workers)
                while flying:
                    done, flying = wait(flying, PATIENCE, FIRST_COMPLETED)
                    flying |= handed_out(len(done))
                    for future in done:
                        yield future.result()
            finally:
                unwanted.set()
                pool.shutdown(wait=True, cancel_futures=True)
