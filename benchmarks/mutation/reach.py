"""Which tests there are for a line: those that are short, and run it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import pytest
from coverage import Coverage

from .session import Answer, run


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
    """Run tests; return those that pass in so many CPU seconds, and the others."""
    coverage = Coverage(data_file=None, include=[str(each) for each in sources])
    coverage.start()
    coverage.switch_context(items[0].nodeid)
    passing, others = {}, []
    names = [*(item.nodeid for item in items[1:]), ""]
    for (item, passed, seconds), following in zip(run(items), names, strict=True):
        coverage.switch_context(following)
        if passed and seconds <= longest:
            passing[item.nodeid] = seconds
        else:
            others.append(item.nodeid)
    coverage.stop()
    lines: dict[str, dict[str, list[int]]] = {}
    data = coverage.get_data()
    for path in data.measured_files():
        relative = Path(path).relative_to(Path.cwd()).as_posix()
        for line, contexts in data.contexts_by_lineno(path).items():
            for name in contexts:
                lines.setdefault(name, {}).setdefault(relative, []).append(line)
    found = [Test(name, seconds, lines.get(name, {})) for name, seconds in passing.items()]
    return {"tests": found, "left_out": others}


def fitting(tests: Sequence[Test], path: str, line: int, most: float) -> tuple[list[str], float]:
    """Return the tests to run for a line, and how long they take (s).

    First those of the file that has its name from the source's, then the shortest files.
    All tests of a file that runs the line: what one of them computes another may look at. For a
    line that is run as the file is imported, those that run anything of that file.
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

    chosen, total = [], 0.0
    for group in sorted(by_file.values(), key=order):
        for each in group:
            if total + each.seconds <= most:
                chosen.append(each.name)
                total += each.seconds
    return chosen, total
