"""Which tests there are for a line: those that are short, and run it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import pytest
from coverage import Coverage

from .session import Answer, apart, run


class Test(NamedTuple):
    """A test that passes: its name, its CPU time (s), and the lines that it runs, by file."""

    name: str
    seconds: float
    lines: dict[str, list[int]]

    @property
    def file(self) -> str:
        """Return the file in which it stands."""
        return self.name.partition("::")[0]


def watched(items: Sequence[pytest.Item], sources: Sequence[Path], longest: float) -> Answer:
    """Return the tests that pass in so many CPU seconds, and the others.

    Each runs in a process of its own, and pays for its fixtures, as it may have to for a mutant.
    """
    passing, others = [], []
    for item in items:
        answer = apart(lambda item=item: lines_run(item, sources), longest).answer or {}
        if answer.get("passed") and answer["seconds"] <= longest:
            passing.append(Test(item.nodeid, answer["seconds"], answer["lines"]))
        else:
            others.append(item.nodeid)
    return {"tests": passing, "left_out": others}


def lines_run(item: pytest.Item, sources: Sequence[Path]) -> Answer:
    """Run a test; return whether it passed, its CPU time, and the lines that it ran."""
    coverage = Coverage(data_file=None, include=[str(each) for each in sources])
    coverage.start()
    ((_, passed, seconds),) = run([item])
    coverage.stop()
    data, lines = coverage.get_data(), {}
    for path in data.measured_files():
        lines[Path(path).relative_to(Path.cwd()).as_posix()] = data.lines(path)
    return {"passed": passed, "seconds": seconds, "lines": lines}


def fitting(tests: Sequence[Test], path: str, line: int, most: float) -> tuple[list[str], float]:
    """Return the tests to run for a line, and how long they take (s).

    First those of the file that has its name from the source's, then the shortest files; of a
    file, first the shortest that run the line. All tests of a file that runs the line: what one of
    them computes another may look at. For a line that is run as the file is imported, those that
    run anything of that file.
    """
    reaching = {each.file for each in tests if line in each.lines.get(path, ())}
    reaching = reaching or {each.file for each in tests if path in each.lines}
    by_file: dict[str, list[Test]] = {}
    for each in tests:
        if each.file in reaching:
            by_file.setdefault(each.file, []).append(each)
    own = f"test_{Path(path).name}"

    def order(group: list[Test]) -> tuple[bool, float]:
        return Path(group[0].file).name != own, sum(each.seconds for each in group)

    def speed(each: Test) -> tuple[bool, float]:
        return line not in each.lines.get(path, ()), each.seconds

    chosen, total = [], 0.0
    for group in sorted(by_file.values(), key=order):
        for each in sorted(group, key=speed):
            if total + each.seconds <= most:
                chosen.append(each.name)
                total += each.seconds
    return chosen, total
