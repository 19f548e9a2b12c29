"""Which tests there are for a line: those that are short, and run it."""

from __future__ import annotations

import json
import signal
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from .trial import QUIET, Answer


class Test(NamedTuple):
    """A test that passes: its name, its CPU time (s), and the lines that it runs, by file."""

    name: str
    seconds: float
    lines: dict[str, list[int]]

    @property
    def file(self) -> str:
        """Return the file in which it stands."""
        return self.name.partition("::")[0]


class TooSlow(BaseException):
    """A test has taken longer than it may."""


def stop(*_: Any) -> None:
    """End the test at hand."""
    raise TooSlow


class Watch:
    """A plugin of pytest that notes of each test how long it takes and which lines it runs."""

    def __init__(self, sources: Sequence[str], longest: float) -> None:
        """Take files and folders to watch, and how long a test may take (s)."""
        from coverage import Coverage

        self.coverage = Coverage(data_file=None, include=[f"{each}*" for each in sources])
        self.longest = longest
        self.passed: dict[str, float] = {}
        self.failed: set[str] = set()

    def pytest_runtest_protocol(self, item: Any) -> None:
        """Begin a test."""
        self.coverage.switch_context(item.nodeid)
        self.began = time.process_time()
        signal.setitimer(signal.ITIMER_VIRTUAL, self.longest)

    def pytest_runtest_logfinish(self, nodeid: str) -> None:
        """End a test."""
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        self.passed[nodeid] = time.process_time() - self.began

    def pytest_runtest_logreport(self, report: Any) -> None:
        """Look at how a test went."""
        if not report.passed:
            self.failed.add(report.nodeid)

    def tests(self) -> Iterator[Test]:
        """Yield the tests that have passed, with what they have run."""
        data = self.coverage.get_data()
        lines: dict[str, dict[str, list[int]]] = {}
        for path in data.measured_files():
            relative = Path(path).relative_to(Path.cwd()).as_posix()
            for line, names in data.contexts_by_lineno(path).items():
                for name in names:
                    lines.setdefault(name, {}).setdefault(relative, []).append(line)
        for name, seconds in self.passed.items():
            if name not in self.failed:
                yield Test(name, seconds, lines.get(name, {}))


def watched(sources: Sequence[str], tests: Sequence[str], longest: float) -> Answer:
    """Run tests, each for so many seconds at most; return those that pass."""
    import pytest

    signal.signal(signal.SIGVTALRM, stop)
    watch = Watch(sources, longest)
    watch.coverage.start()
    pytest.main([*QUIET, *tests], plugins=[watch])
    watch.coverage.stop()
    return {"tests": list(watch.tests()), "left_out": sorted(watch.failed)}


def fitting(tests: Sequence[Test], path: str, line: int, most: float) -> tuple[list[str], float]:
    """Return the tests to run for a line, the shortest files first, and how long they take (s).

    All tests of a file that runs the line: what one of them computes another may look at. For a
    line that is run as the file is imported, those that run anything of that file.
    """
    reaching = {each.file for each in tests if line in each.lines.get(path, ())}
    reaching = reaching or {each.file for each in tests if path in each.lines}
    by_file: dict[str, list[Test]] = {}
    for each in tests:
        if each.file in reaching:
            by_file.setdefault(each.file, []).append(each)
    chosen, total = [], 0.0
    for group in sorted(by_file.values(), key=lambda group: sum(each.seconds for each in group)):
        for each in sorted(group, key=lambda each: path not in each.lines):
            if total + each.seconds <= most:
                chosen.append(each.name)
                total += each.seconds
    return chosen, total


def kept(path: Path) -> list[Test] | None:
    """Return what was seen before."""
    if not path.exists():
        return None
    return [Test(*row) for row in json.loads(path.read_text())["tests"]]
