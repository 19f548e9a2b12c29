"""Progress and outcome of a study, for a terminal, a log or a program."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import isfinite
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from stiction.cli.progress import EVERY, FIRST, clock, in_time, print_line
from stiction.cli.terminal import say

if TYPE_CHECKING:
    from stiction.study.execution.sweep import Tally
    from stiction.study.view.summary import Summary

Report = Callable[["Tally"], None]
Conclude = Callable[[Path, "Summary", int], None]
JSON_EVERY = 1.0  # s between lines of JSON


@contextmanager
def show_tally(quiet: bool, json_lines: bool) -> Iterator[tuple[Report | None, Conclude]]:
    """Yield two functions: one takes a study's tally while it runs, one its outcome.

    The latter is the store, its summary, and how many runs were there before.
    """
    if json_lines:
        yield _now_and_then(_print_tally, JSON_EVERY), _print_summary
    elif quiet:
        yield None, _tell_failures
    else:
        with _bar() as report:
            yield report, _tell


def _now_and_then(report: Report, every: float, first: float = 0.0) -> Report:
    """Return a report that passes on one tally per interval, not before so many seconds."""
    due = [monotonic() + first]

    def sometimes(tally: Tally) -> None:
        if monotonic() >= due[0]:
            due[0] = monotonic() + every
            report(tally)

    return sometimes


def _print_tally(tally: Tally) -> None:
    line = {
        "runs": tally.runs,
        "done": tally.before + tally.now,
        "failed": tally.failed,
        "runs_per_second": round(tally.rate, 3),
        "seconds_left": round(tally.left, 1) if isfinite(tally.left) else None,
    }
    print(json.dumps(line), flush=True)


def _print_summary(output: Path, result: Summary, before: int) -> None:
    line: dict[str, Any] = {
        "store": str(output),
        "runs": result.runs,
        "done": result.runs - result.pending,
        "before": before,
        "failed": dict(result.failed),
    }
    if result.first is not None:
        line["first_failure"] = str(result.first)
    print(json.dumps(line), flush=True)


def _tell_failures(output: Path, result: Summary, before: int) -> None:
    if result.first is not None:
        say(f"{output}: {_failures(result)}", error=True)


def _tell(output: Path, result: Summary, before: int) -> None:
    there = f", of which {before} {'was' if before == 1 else 'were'} already there" * bool(before)
    say(f"{output}: {result.runs - result.pending} runs{there}")
    if result.first is not None:
        say(_failures(result))


def _failures(result: Summary) -> str:
    counts = ", ".join(f"{count} {end.replace('_', ' ')}" for end, count in result.failed.items())
    return f"{sum(result.failed.values())} failed ({counts}); the first at {result.first}"


@contextmanager
def _bar() -> Iterator[Report | None]:
    """Show a bar with the rate and the time left on a terminal, elsewhere a line now and then."""
    console = Console(stderr=True, emoji=False)
    if not console.is_terminal:
        yield _now_and_then(_print_line, EVERY, FIRST)
        return
    columns = (
        TextColumn("{task.description}"),
        BarColumn(bar_width=20),
        TextColumn("{task.fields[rate]}"),
        TimeElapsedColumn(),
        TextColumn("{task.fields[left]}"),
    )
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("making ready", total=None, rate="", left="")

        def report(tally: Tally) -> None:
            done = tally.before + tally.now
            bar.update(
                task,
                description=f"{done} of {tally.runs} runs",
                total=tally.runs,
                completed=done,
                rate=f"{tally.rate:.3g} a second",
                left=f"{clock(tally.left)} left" + _so_far(tally.failed),
            )

        yield report


def _print_line(tally: Tally) -> None:
    done = tally.before + tally.now
    left = f", about {in_time(tally.left)} left" if isfinite(tally.left) else ""
    told = f"{done} of {tally.runs} runs, {tally.rate:.3g} a second{left}"
    print_line(told + _so_far(tally.failed))


def _so_far(failed: int) -> str:
    return f", {failed} failed" if failed else ""
