"""``python -m benchmarks``: time our solver beside its peers and say how accurate each is."""

from __future__ import annotations

import argparse
from pathlib import Path

from rich.console import Console
from rich.progress import MofNCompleteColumn, Progress, TimeElapsedColumn

from . import ours, peers
from .accuracy import accuracy
from .contestant import Contestant, Failed
from .report import save, show
from .result import Row
from .timing import round_robin


def main() -> None:
    """Run everything once and report it."""
    options = _options()
    console = Console()
    columns = (*Progress.get_default_columns()[:2], MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console) as progress:
        rows, reference = _run(progress, options.repeats, options.budget)
    show(console, rows, reference)
    if options.out is not None:
        save(options.out, rows, reference)
        console.print(f"Written: benchmark.md and benchmark.json in {options.out}")


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--out", type=Path, help="directory for benchmark.md and benchmark.json")
    parser.add_argument("--repeats", type=int, default=9, help="timed rounds (default 9)")
    parser.add_argument(
        "--budget",
        type=float,
        default=4.0,
        help="seconds after which a solver sits out the later rounds (default 4)",
    )
    options = parser.parse_args()
    if options.repeats < 1:
        parser.error(f"--repeats must be at least 1, not {options.repeats}")
    return options


def _run(progress: Progress, repeats: int, budget: float):
    """Return the rows and the reference solution."""
    preparing = progress.add_task("compile, reference", total=2)
    everyone = [*ours.contestants(), *peers.contestants()]
    progress.advance(preparing)
    reference = ours.reference()
    progress.advance(preparing)
    comparing = progress.add_task("accuracy", total=len(everyone))
    rows: list[Row] = []
    for contestant in everyone:
        rows.append(_compare(contestant, reference))
        progress.advance(comparing)
    running = [i for i, row in enumerate(rows) if row.accuracy is not None]
    timing = progress.add_task("timing", total=repeats * len(running))
    times = round_robin(
        [everyone[i] for i in running],
        repeats=repeats,
        budget=budget,
        after_each=lambda: progress.advance(timing),
    )
    for i, own in zip(running, times, strict=True):
        rows[i] = rows[i]._replace(times=own)
    return rows, reference


def _compare(contestant: Contestant, reference) -> Row:
    """Return the row of a contestant with its accuracy, or with the reason why it has none."""
    row = Row(contestant.solver, contestant.settings, note=contestant.missing)
    if contestant.missing:
        return row
    try:
        return row._replace(accuracy=accuracy(contestant.solve(), reference))
    except Failed as reason:
        return row._replace(note=f"failed: {reason}")


if __name__ == "__main__":
    main()
