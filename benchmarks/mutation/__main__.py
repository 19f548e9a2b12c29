"""``python -m benchmarks.mutation``: change one place at a time, and see whether a test fails.

Goes on where it was stopped: what was found is kept in a folder, under the change and a digest of
the file. A sample depends on the seed and on the sources. Exit status 1 if more than a share of
the mutants survive that are not known to be equivalent.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from .mutants import Mutant, digest, draw_mutants, files, mutate
from .python import change
from .reach import Test, fitting, watch_tests
from .report import equivalent, report
from .session import Answer, apart, first_failure, with_tests

SOURCES = (
    "src/stiction/solver",
    "src/stiction/friction",
    "src/stiction/analysis/motion/cycles.py",
    "src/stiction/analysis/motion/cycle_columns.py",
    "src/stiction/analysis/motion/hesitations.py",
    "src/stiction/analysis/signals/peak_refinement.py",
    "src/stiction/analysis/signals/reversals.py",
    "src/stiction/analysis/signals/turning_points.py",
)
COMPILING = (Path("src/stiction/solver/compilation"),)  # in plain Python nothing is compiled
TESTS = (  # of pieces, in plain Python; whole runs take long there
    "tests/unit/solver",
    "tests/unit/friction",
    "tests/unit/analysis/motion/test_cycles.py",
    "tests/unit/analysis/motion/test_hesitations.py",
    "tests/unit/analysis/signals",
)
ROOM, TIMES = 2.0, 3.0  # s, and multiples of what the tests take: then it is endless
ALLOWED = 0.05  # of the mutants
KILLED, SURVIVED, TIMEOUT, UNREACHED = "killed", "survived", "timeout", "unreached"

Row = dict[str, Any]


def main() -> int:
    """Try the mutants asked for; return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mutation", description=__doc__)
    parser.add_argument("--sources", nargs="+", type=Path, default=SOURCES, help="files, folders")
    parser.add_argument("--without", nargs="*", type=Path, default=COMPILING, help="files, folders")
    parser.add_argument("--tests", nargs="+", default=TESTS, help="files, folders")
    parser.add_argument("--mutants", type=int, default=500, help="how many")
    parser.add_argument("--seed", type=int, default=1, help="of the sample")
    parser.add_argument(
        "--results", type=Path, default=Path("mutation-results"), help="folder to keep"
    )
    parser.add_argument(
        "--longest", type=float, default=1.0, help="CPU s that a test takes at most"
    )
    parser.add_argument("--most", type=float, default=10.0, help="CPU s of tests for one mutant")
    parser.add_argument("--again", action="store_true", help="try those that survived again")
    options = parser.parse_args()
    options.results.mkdir(parents=True, exist_ok=True)
    rows: list[Row] = []
    with_tests(options.tests, lambda items: rows.extend(try_mutants(items, options)))
    left = report(rows, equivalent())
    return 0 if left <= ALLOWED * len(rows) else 1


def try_mutants(items: Sequence[pytest.Item], options: argparse.Namespace) -> Iterator[Row]:
    """Yield what came of each mutant, known from before or tried now."""
    without = {path for each in options.without for path in files([each])}
    sources = [path for path in files(map(Path, options.sources)) if path not in without]
    sample = draw_mutants(sources, options.mutants, options.seed, options.results)
    path = options.results / "mutants.jsonl"
    lines = path.read_text().splitlines() if path.exists() else []
    known = {tuple(row["mutant"]): row for row in map(json.loads, lines)}
    tests: list[Test] | None = None
    by_name = {item.nodeid: item for item in items}
    with path.open("a") as file:
        for number, mutant in enumerate(sample):
            row = known.get(mutant)
            if row is None or (options.again and row["outcome"] in (SURVIVED, UNREACHED)):
                tests = tests or tests_by_line(items, sources, options)
                row = outcome(mutant, tests, by_name, options.most)
                print(json.dumps(row), file=file, flush=True)
                print(f"{number + 1}: {row['outcome']}", *mutant[:2], mutant.after, flush=True)
            yield row


def tests_by_line(
    items: Sequence[pytest.Item], sources: Sequence[Path], options: argparse.Namespace
) -> list[Test]:
    """Return the tests with the lines that they run, from the folder or by running them."""
    known, left_out = watch_tests(items, sources, options.longest, options.results)
    for name in left_out:
        print(f"left out, as it takes long or is of compiled code: {name}")
    print(f"{len(known)} tests, {sum(each.seconds for each in known):.0f} s", flush=True)
    return known


def outcome(
    mutant: Mutant, tests: Sequence[Test], items: dict[str, pytest.Item], most: float
) -> Row:
    """Try a mutant."""
    chosen, seconds = fitting(tests, mutant.path, mutant.line, most)
    row: Row = {"mutant": mutant, "tests": len(chosen), "by": ""}
    if not chosen:
        return row | {"outcome": UNREACHED}
    path = Path(mutant.path)
    text = path.read_text(encoding="utf-8")
    if digest(text) != mutant.made_from:
        raise SystemExit(f"{path} was changed meanwhile: begin again")
    changed = mutate(text, mutant.operator, mutant.occurrence)
    chosen_items, limit = [items[name] for name in chosen], ROOM + TIMES * seconds

    def task() -> Answer:
        try:
            change(path, changed)
        except Exception as error:
            return {"failed": f"as it is imported: {error!r}"}
        return {"failed": first_failure(chosen_items)}

    answer, stopped = apart(task, limit)
    if stopped:
        unchanged = apart(lambda: {"failed": first_failure(chosen_items)}, limit)
        if unchanged.stopped:
            raise SystemExit(f"the tests of {path} take longer than {limit:.0f} s without a change")
        return row | {"outcome": TIMEOUT}
    failed = (answer or {"failed": "the process died"}).get("failed", "something raised")
    return row | {"outcome": KILLED if failed else SURVIVED, "by": failed}


if __name__ == "__main__":
    sys.exit(main())
