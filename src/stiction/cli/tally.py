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
from rich.progress import BarColumn, Progress, ProgressColumn, Task, TextColumn, TimeElapsedColumn
from rich.text import Text

from stiction.cli.terminal import say
from stiction.progress.display import in_time, line, now_and_then, print_line

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
        yield _at_most_every(JSON_EVERY, _print_tally), _print_summary
    elif quiet:
        yield lambda tally: None, _tell_failures
    else:
        with _bar() as report:
            yield report, _tell


def _at_most_every(seconds: float, report: Report) -> Report:
    """Return a report that passes on one tally in so many seconds."""
    due = [0.0]

    def sometimes(tally: Tally) -> None:
        if monotonic() >= due[0]:
            due[0] = monotonic() + seconds
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
def _bar() -> Iterator[Report]:
    """Show a bar on a terminal, elsewhere a line now and then; both go on while no run comes."""
    console, latest = Console(stderr=True, emoji=False), Latest()
    if not console.is_terminal:
        with now_and_then(lambda: print_line(latest.so_far())):
            yield latest.take
        return
    columns = (
        TextColumn("{task.description}"),
        BarColumn(bar_width=20),
        TimeElapsedColumn(),
        PaceColumn(latest),
    )
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("making ready", total=None)

        def report(tally: Tally) -> None:
            latest.take(tally)
            done = tally.before + tally.now
            bar.update(task, description=runs_done(tally), total=tally.runs, completed=done)

        yield report


class Latest:
    """The latest tally, and how long ago that was."""

    def __init__(self) -> None:
        """Begin without any."""
        self._began = self._came = monotonic()
        self._tally: Tally | None = None

    def take(self, tally: Tally) -> None:
        """Take note of a tally."""
        self._came, self._tally = monotonic(), tally

    def so_far(self) -> str:
        """Return the progress in a line."""
        seconds = monotonic() - self._began
        if self._tally is None:
            return line("making ready", 0.0, seconds)
        return f"{runs_done(self._tally)} after {in_time(seconds)}{self.pace()}"

    def pace(self) -> str:
        """Return the known pace: a rate and the time left, or the time since the last run."""
        tally, waited = self._tally, monotonic() - self._came
        if tally is None:
            return ""
        left = tally.left_after(waited)
        if isfinite(left):
            told = f", {tally.rate:.3g} a second, about {in_time(left)} left"
        else:
            told = f", the latest {in_time(waited)} ago"
        return f"{told}, {tally.failed} failed" if tally.failed else told


class PaceColumn(ProgressColumn):
    """The pace, made anew at each refresh of the bar, and not when a run comes."""

    def __init__(self, latest: Latest) -> None:
        """Tell of the latest tally."""
        super().__init__()
        self._latest = latest

    def render(self, task: Task) -> Text:
        """Return the pace."""
        return Text(self._latest.pace().removeprefix(", "))


def runs_done(tally: Tally) -> str:
    """Return how many runs of a study are done."""
    return f"{tally.before + tally.now} of {tally.runs} runs"
