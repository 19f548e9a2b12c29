"""Tests in a process of their own, on sources of which one may be changed.

A process is forked from one in which only the libraries are loaded, so that it has the package
itself still to import, with the change.
"""

from __future__ import annotations

import importlib
import json
import math
import os
import resource
import select
import signal
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, SourceFileLoader
from importlib.util import spec_from_file_location
from pathlib import Path
from types import CodeType
from typing import Any, NamedTuple

LIBRARIES = (
    "coverage",
    "h5netcdf",
    "matplotlib",
    "numba.extending",
    "pint",
    "pydantic",
    "pytest",
    "rich.progress",
    "scipy.interpolate",
    "scipy.optimize",
    "scipy.signal",
    "scipy.stats",
    "xarray",
    "zarr",
)
FORGIVEN = ("acos", "asin", "cosh", "exp", "expm1", "log", "log1p", "log10", "sinh", "sqrt")
ROOM = 6 << 30  # bytes of memory: a change may ask for any amount
PATIENCE = 20  # times the CPU time, by the clock: a test may wait for what never comes
QUIET = ("-q", "-p", "no:cacheprovider", "-o", "addopts=--import-mode=importlib")

Answer = dict[str, Any]


class Outcome(NamedTuple):
    """How a process ended: its answer, or None if it was stopped or died."""

    answer: Answer | None
    stopped: bool


def load_libraries() -> None:
    """Import what the tests need beside the package."""
    for name in LIBRARIES:
        with suppress(ImportError):
            importlib.import_module(name)
    for name in FORGIVEN:
        forgiving(name)
    assert "stiction" not in sys.modules, "a process forked from here would not see the change"


def forgiving(name: str) -> None:
    """Have a function of `math` return infinity or NaN where Python raises: compiled code does."""
    strict = getattr(math, name)

    def forgiven(*numbers: float) -> float:
        try:
            return float(strict(*numbers))
        except OverflowError:
            return math.inf
        except ValueError:
            return math.nan

    setattr(math, name, forgiven)


def apart(task: Callable[[], Answer], seconds: float) -> Outcome:
    """Run a task in a forked process, for so many seconds of CPU time at most."""
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
    resource.setrlimit(resource.RLIMIT_AS, (ROOM, ROOM))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    try:
        nowhere = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(nowhere, stream)
        answer = task()
        with open(sending, "w") as pipe:
            json.dump(answer, pipe)
    finally:
        os._exit(0)


class Changed(SourceFileLoader):
    """A loader of a module with another text."""

    def __init__(self, name: str, path: str, text: str) -> None:
        """Take the module, and the text to compile."""
        super().__init__(name, path)
        self.text = text

    def get_code(self, fullname: str) -> CodeType:
        """Return the compiled text."""
        return compile(self.text, self.path, "exec")


class Finder(MetaPathFinder):
    """Finds the changed module before its file is found."""

    def __init__(self, path: Path, text: str) -> None:
        """Take the changed file, and its text."""
        self.path, self.text = path.resolve(), text
        parts = self.path.with_suffix("").parts
        parts = parts[len(parts) - parts[::-1].index("src") :]
        self.name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)

    def find_spec(self, fullname: str, *_: Any) -> ModuleSpec | None:
        """Return how to load the changed module."""
        if fullname != self.name:
            return None
        loader = Changed(fullname, str(self.path), self.text)
        return spec_from_file_location(fullname, self.path, loader=loader)


class First:
    """A plugin of pytest that notes the first test that fails."""

    failed = ""

    def pytest_runtest_logreport(self, report: Any) -> None:
        """Look at how a test went."""
        if report.failed and not self.failed:
            self.failed = report.nodeid

    def pytest_collectreport(self, report: Any) -> None:
        """Look at how a file was read."""
        self.pytest_runtest_logreport(report)


def run_tests(tests: Sequence[str], change: tuple[Path, str] | None = None) -> Answer:
    """Run tests until one fails; return pytest's exit status and the name of that test."""
    import pytest

    if change is not None:
        sys.meta_path.insert(0, Finder(*change))
    first = First()
    status = pytest.main([*QUIET, "-x", *tests], plugins=[first])
    return {"status": int(status), "failed": first.failed}
