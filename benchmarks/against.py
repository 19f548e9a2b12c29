"""``python -m benchmarks.against [REVISION]``: is this tree slower than a revision of it?

Both are built and timed here and now, by the same cases, in turn, so that a noisy machine treats
them alike; the statement is the ratio of paired times with its interval. A case is timed until the
interval lies on one side of the limit, or the rounds are used up: then the median decides. Exit
status 1 if a case is slower than the limit allows, 2 if there is nothing to compare.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from .regression.trees import ROOT, Absent, Worker, at_work, changed, known, laid_out
from .regression.verdict import CONFIDENCE, Ratio, ratio, slower
from .regression.workload import CASES

ROUNDS = 10  # between two looks at the interval


def main() -> int:
    """Time this tree against a revision of it, and say how they compare."""
    options = _options()
    console = Console()
    if not known(options.revision):
        console.print(f"git knows no revision {options.revision!r}; name a branch, tag or commit")
        return 2
    if not changed(options.revision):
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
    parser.add_argument("--rounds", type=int, default=80, help="most rounds a case (default 80)")
    return parser.parse_args()


Times = tuple[list[float], list[float]]


def _compare(
    progress: Progress, sources: Sequence[Path], options: argparse.Namespace
) -> tuple[dict[str, Times], list[str]]:
    """Return the times of each case in both trees, and why cases were left out."""
    found: dict[str, Times] = {}
    notes = []
    with at_work(*sources) as workers:
        building = progress.add_task("build", total=len(CASES))
        for case in CASES:
            try:
                _both_at_once(workers, case)
                found[case] = ([], [])
            except Absent as reason:
                notes.append(f"{case}: left out, one of the two has not what it takes: {reason}")
            progress.advance(building)
        for case, times in found.items():
            task = progress.add_task(case, total=options.rounds)
            while len(times[0]) < options.rounds:
                _in_turn(workers, case, times)
                progress.advance(task, ROUNDS)
                if slower(ratio(*times), options.limit) is not None:
                    break
            progress.update(task, completed=options.rounds)
    return found, notes


def _both_at_once(workers: Sequence[Worker], case: str) -> None:
    """Run a case in both trees, which compiles what is not compiled yet."""
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


def _in_turn(workers: Sequence[Worker], case: str, times: Times) -> None:
    """Time a case in one tree after the other, each first in half of the rounds."""
    for i in range(ROUNDS):
        for k in (0, 1) if i % 2 == 0 else (1, 0):
            workers[k].ask(case)
            times[k].append(workers[k].answer())


def _report(
    console: Console, found: dict[str, Times], notes: Sequence[str], options: argparse.Namespace
) -> int:
    """Print what was found and return the exit status."""
    headings = ("case", "this tree (ms)", f"{options.revision} (ms)", "ratio", "interval", "rounds")
    table = Table(*headings, title=f"fastest times; ratio of pairs, {CONFIDENCE:.0%} interval")
    too_slow = []
    for case, (now, before) in found.items():
        r = ratio(now, before)
        verdict = slower(r, options.limit)
        if r.median > options.limit if verdict is None else verdict:
            too_slow.append((case, r))
        fastest = (f"{1e3 * min(times):.2f}" for times in (now, before))
        interval = f"{r.low:.3f} to {r.high:.3f}"
        table.add_row(case, *fastest, f"{r.median:.3f}", interval, str(len(now)))
    console.print(table)
    for note in notes:
        console.print(note, highlight=False)
    if not found:
        console.print("no case could be timed in both trees")
        return 2
    for case, r in too_slow:
        console.print(
            f"SLOWER: {case} takes {_words(r)}, limit {options.limit:g}", style="bold red"
        )
    if not too_slow:
        console.print(f"no case is slower than {options.limit:g} times {options.revision}")
    return 1 if too_slow else 0


def _words(r: Ratio) -> str:
    return f"{r.median:.3f} times as long ({r.low:.3f} to {r.high:.3f})"


if __name__ == "__main__":
    sys.exit(main())
