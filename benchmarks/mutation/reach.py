"""The tests for a line: short ones that run it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from coverage import Coverage

from .mutants import digest
from .session import apart, run

TOGETHER = 10.0  # times what one test takes at most: the tests of a file


class Test(NamedTuple):
    """A test that passes: its name, its CPU time (s), and the lines that it runs, by file."""

    name: str
    seconds: float
    lines: dict[str, list[int]]

    @property
    def file(self) -> str:
        """Return the file in which it stands."""
        return self.name.partition("::")[0]


def watch_tests(
    items: Sequence[pytest.Item], sources: Sequence[Path], longest: float, place: Path
) -> tuple[list[Test], list[str]]:
    """Return the tests that pass in so many CPU seconds, and the names of the others.

    The tests of a file run in one process; where they take too long together, each in its own, in
    which it pays for its fixtures, as it may have to for a mutant. The lines of a file's tests are
    stored in a folder, for as long as neither that file nor the sources change.
    """
    groups: dict[str, list[pytest.Item]] = {}
    for item in items:
        groups.setdefault(item.nodeid.partition("::")[0], []).append(item)
    texts = [path.read_text(encoding="utf-8") for path in sources]
    tests: list[Test] = []
    others: list[str] = []
    for name, group in groups.items():
        names = [item.nodeid for item in group]
        origin = digest(json.dumps([longest, names, Path(name).read_text("utf-8"), *texts]))
        stored = place / f"tests-{origin}.json"
        if not stored.exists():
            stored.write_text(json.dumps(watched_file(group, sources, longest)))
        short = [Test(*row) for row in json.loads(stored.read_text())]
        print(f"{len(short)} of {len(group)} tests of {name}", flush=True)
        tests += short
        others += sorted(set(names) - {test.name for test in short})
    return tests, others


def watched_file(
    group: Sequence[pytest.Item], sources: Sequence[Path], longest: float
) -> list[Test]:
    """Return those tests of a file that pass in so many CPU seconds."""
    found = watched_together(group, sources, TOGETHER * longest)
    if found is None:
        each = [watched_together([item], sources, longest) for item in group]
        found = [row for rows in each for row in rows or ()]
    return [Test(*row[:3]) for row in found if row[3] and row[1] <= longest]


def watched_together(
    items: Sequence[pytest.Item], sources: Sequence[Path], most: float
) -> list[list[Any]] | None:
    """Return a row for each test, of a `Test` and whether it passed; None if they take too long."""
    answer = apart(lambda: {"rows": rows_of(items, sources)}, most).answer
    return (answer or {}).get("rows")


def rows_of(items: Sequence[pytest.Item], sources: Sequence[Path]) -> list[Any]:
    """Run tests; return their names, CPU times, lines by file, and whether they passed."""
    coverage = Coverage(data_file=None, include=[str(each) for each in sources])
    # pytest would make an error of its warning of a test that runs none of these lines
    coverage.set_option("run:disable_warnings", ["no-data-collected"])
    coverage.start()
    coverage.switch_context(items[0].nodeid)
    rows = []
    names = [*(item.nodeid for item in items[1:]), ""]
    for (item, passed, seconds), following in zip(run(items), names, strict=True):
        coverage.switch_context(following)
        rows.append((item.nodeid, seconds, {}, passed))
    coverage.stop()
    data, lines = coverage.get_data(), {row[0]: row[2] for row in rows}
    for path in data.measured_files():
        relative = Path(path).relative_to(Path.cwd()).as_posix()
        for line, contexts in data.contexts_by_lineno(path).items():
            for name in contexts:
                if name in lines:
                    lines[name].setdefault(relative, []).append(line)
    return rows


def fitting(tests: Sequence[Test], path: str, line: int, most: float) -> tuple[list[str], float]:
    """Return the tests to run for a line, and how long they take (s).

    First those in the place that mirrors the source's, then the shortest. For a line that is run as
    the file is imported, those that run anything of that file, and before them those that run no
    line at all: they may read a constant, as the test of those printed in `docs/method.md` does.
    """
    reaching = [each for each in tests if line in each.lines.get(path, ())]
    reaching = reaching or [each for each in tests if path in each.lines or not each.lines]
    source = Path(path.replace("src/stiction", "tests/unit"))
    own = source.with_name(f"test_{source.name}").as_posix()

    def rank(test: Test) -> tuple[bool, bool, float]:
        return bool(test.lines), test.file != own, test.seconds

    chosen, total = [], 0.0
    for each in sorted(reaching, key=rank):
        if total + each.seconds <= most:
            chosen.append(each.name)
            total += each.seconds
    return chosen, total
