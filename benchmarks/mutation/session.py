"""One session of pytest, which reads all tests once; processes that run them are forked from it."""

from __future__ import annotations

import json
import os
import resource
import select
import signal
import time
import traceback
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

import pytest
from _pytest.runner import runtestprotocol

from .python import forgiving

MEMORY = 6 << 30  # bytes: a change may ask for any amount
PATIENCE = 20  # times the CPU time, by the clock: a test may wait for what never comes
ARGUMENTS = ("-q", "-p", "no:cacheprovider", "-o", "addopts=--import-mode=importlib")
RUNS = {"slider", "paper_run", "sharp_run"}  # fixtures for whole simulations: minutes here

Answer = dict[str, Any]


class Outcome(NamedTuple):
    """How a process ended: its answer, or None if it was stopped or died."""

    answer: Answer | None
    stopped: bool


class Session:
    """A plugin of pytest that hands the tests it has read to a task, instead of running them."""

    def __init__(self, task: Callable[[list[pytest.Item]], None]) -> None:
        """Take the task."""
        self.task = task

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Do the task, once all tests are read, with those that run no whole simulation."""
        self.task([item for item in session.items if not RUNS & fixtures(item)])
        return True


def fixtures(item: Any) -> set[str]:
    """Return the names of a test's fixtures, without its parameters."""
    parameters = item.callspec.params if hasattr(item, "callspec") else ()
    return set(item.fixturenames) - set(parameters)


def with_tests(paths: Sequence[str], task: Callable[[list[pytest.Item]], None]) -> None:
    """Read tests, and do a task with them."""
    forgiving()
    pytest.main([*ARGUMENTS, *paths], plugins=[Session(task)])


def apart(task: Callable[[], Answer], seconds: float) -> Outcome:
    """Do a task in a forked process, for so many seconds of CPU time at most."""
    receiving, sending = os.pipe()
    child = os.fork()
    if child == 0:
        _child(task, seconds, sending)
    os.close(sending)
    ready, _, _ = select.select([receiving], [], [], PATIENCE * seconds)
    if not ready:
        os.kill(child, signal.SIGKILL)
    with open(receiving, "rb") as pipe:
        content = pipe.read() if ready else b""
    _, status = os.waitpid(child, 0)
    stopped = not ready or (os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGXCPU)
    return Outcome(json.loads(content) if content else None, stopped)


def _child(task: Callable[[], Answer], seconds: float, sending: int) -> None:
    limit = int(seconds) + 1
    resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    try:
        nowhere = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(nowhere, stream)
        try:
            answer = task()
        except BaseException:
            answer = {"died": traceback.format_exc()}
        with open(sending, "w") as pipe:
            json.dump(answer, pipe)
    finally:
        os._exit(0)


def run(items: Sequence[pytest.Item]) -> Iterator[tuple[pytest.Item, bool, float]]:
    """Run tests; yield each with whether it passed and how long it took (CPU s).

    None is cut short from inside: what it holds, such as a lock, would be held for good.
    """
    for item, following in zip(items, [*items[1:], None], strict=True):
        began = time.process_time()
        reports = runtestprotocol(item, log=False, nextitem=following)
        yield item, all(each.passed for each in reports), time.process_time() - began


def first_failure(items: Sequence[pytest.Item]) -> str:
    """Run tests until one fails; return its name, or nothing."""
    return next((item.nodeid for item, passed, _ in run(items) if not passed), "")
