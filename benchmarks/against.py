"""``python -m benchmarks.against [REVISION]``: the speed of this tree against a revision of it.

Both are built and timed here and now, by the same cases, in turn, so that a noisy machine treats
them alike. Each generation starts fresh processes, since two processes may differ by some per cent
for as long as they live, and gives one ratio a case: the median over pairs of runs. Generations go
on until the interval of those ratios lies on one side of the limit, or until there have been
enough: then their median decides. Exit status 1 if a case is slower than the limit allows, 2 if
there is nothing to compare.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import NamedTuple

from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from benchmarks.regression.trees import (
    ROOT,
    Absent,
    Worker,
    at_work,
    differs,
    is_revision,
    laid_out,
)
from benchmarks.regression.verdict import CONFIDENCE, Ratio, ratio, slower
from benchmarks.regression.workload import CASES

PAIRS = 6  # of runs, a generation


class Found(NamedTuple):
    """What is known of a case: a ratio from each generation, and all times (s) of both trees."""

    ratios: list[float]
    now: list[float]
    before: list[float]


def main() -> int:
    """Time this tree against a revision of it, and say how they compare."""
    options = _options()
    console = Console()
    if not is_revision(options.revision):
        console.print(f"git knows no revision {options.revision!r}; name a branch, tag or commit")
        return 2
    if not differs(options.revision):
        console.print(
            f"src is what it is in {options.revision}: nothing to compare. Name another revision,"
            " for example HEAD~1 or origin/main."
        )
        return 2
    with laid_out(options.revision) as then, Progress(console=console) as progress:
        found, notes = _compare(progress, (ROOT / "src", then), options)
    return _report(console, found, notes, options)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.against", description=__doc__)
    parser.add_argument("revision", nargs="?", default="main", help="git revision (default main)")
    parser.add_argument("--limit", type=float, default=1.10, help="ratio allowed (default 1.10)")
    parser.add_argument("--generations", type=int, default=14, help="at most (default 14)")
    return parser.parse_args()


def _compare(
    progress: Progress, sources: Sequence[Path], options: argparse.Namespace
) -> tuple[dict[str, Found], list[str]]:
    """Return what is known of each case, and why cases were left out."""
    found, notes = _build(progress, sources)
    undecided = list(found)
    task = progress.add_task("time", total=options.generations * len(found))
    for generation in range(options.generations):
        progress.update(task, description=f"time {len(undecided)} cases")
        order = (0, 1) if generation % 2 == 0 else (1, 0)
        with at_work(*(sources[k] for k in order)) as workers:
            pair = [workers[k] for k in order]
            for case in undecided:
                _pairs(pair, case, found[case])
                progress.advance(task)
        verdicts = {case: slower(ratio(found[case].ratios), options.limit) for case in undecided}
        decided = [case for case in undecided if verdicts[case] is not None]
        progress.advance(task, len(decided) * (options.generations - generation - 1))
        undecided = [case for case in undecided if case not in decided]
        if not undecided:
            break
    return found, notes


def _build(progress: Progress, sources: Sequence[Path]) -> tuple[dict[str, Found], list[str]]:
    """Compile every case in both trees at once; return those that both know."""
    found, notes = {}, []
    task = progress.add_task("build", total=len(CASES))
    with at_work(*sources) as workers:
        for case in CASES:
            try:
                _both(workers, case)
                found[case] = Found([], [], [])
            except Absent as reason:
                notes.append(f"{case}: left out, one of the two has not what it takes: {reason}")
            progress.advance(task)
    return found, notes


def _both(workers: Sequence[Worker], case: str) -> None:
    """Run a case in both trees at once."""
    for worker in workers:
        worker.ask(case)
    absent = []
    for worker in workers:
        try:
            worker.answer()
        except Absent as reason:
            absent.append(reason)
    if absent:
        raise absent[0]


def _pairs(workers: Sequence[Worker], case: str, found: Found) -> None:
    """Time a case in one tree after the other, each first in half of the pairs; note the ratio."""
    _both(workers, case)  # loads what is compiled, and warms up
    times: tuple[list[float], list[float]] = ([], [])
    for i in range(PAIRS):
        for k in (0, 1) if i % 2 == 0 else (1, 0):
            workers[k].ask(case)
            times[k].append(workers[k].answer())
    found.ratios.append(median(a / b for a, b in zip(*times, strict=True)))
    found.now.extend(times[0])
    found.before.extend(times[1])


def _report(
    console: Console, found: dict[str, Found], notes: Sequence[str], options: argparse.Namespace
) -> int:
    """Print what was found and return the exit status."""
    headings = ("case", "this tree", options.revision, "ratio", "interval", "generations")
    table = Table(*headings, title=f"fastest times (ms); median ratio, {CONFIDENCE:.0%} interval")
    too_slow = []
    for case, (ratios, now, before) in found.items():
        r = ratio(ratios)
        verdict = slower(r, options.limit)
        if r.median > options.limit if verdict is None else verdict:
            too_slow.append(f"{case} takes {r.median:.3f} times as long ({_interval(r)})")
        fastest = (f"{1e3 * min(times):.2f}" for times in (now, before))
        table.add_row(case, *fastest, f"{r.median:.3f}", _interval(r), str(len(ratios)))
    console.print(table)
    for note in notes:
        console.print(note, highlight=False)
    if not found:
        console.print("no case could be timed in both trees")
        return 2
    for words in too_slow:
        console.print(f"SLOWER: {words}, limit {options.limit:g}", style="bold red")
    if not too_slow:
        console.print(f"no case takes more than {options.limit:g} times as long")
    return 1 if too_slow else 0


def _interval(r: Ratio) -> str:
    return f"{r.low:.3f} to {r.high:.3f}"


if __name__ == "__main__":
    sys.exit(main())
