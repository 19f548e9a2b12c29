"""Progress on standard error, with the time left: a bar on a terminal, else a line now and then."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from threading import Event, Thread, Timer
from time import monotonic
from typing import Any

from stiction.progress.report import Progress

PATIENCE = 1.0  # seconds of silence before a bar appears
FIRST_LINE, EVERY = 5.0, 60.0  # seconds before the first line, and at most between lines
WATCHED = 0.1  # of the time so far: the pace of a shorter while says little of the time left
BEGUN = 0.02  # of the work: runs begin slowly, in steps, until a map takes cycles at once
told: list[str] = []  # work whose progress is told; what is a part of it tells none of its own


@contextmanager
def telling(title: str) -> Iterator[None]:
    """Keep parts of some work from reports of their own."""
    told.append(title)
    try:
        yield
    finally:
        told.pop()


@contextmanager
def show_progress(title: str) -> Iterator[Progress]:
    """Show progress on standard error; yield a function that takes the fraction."""
    from rich.console import Console  # slow to import: only where work takes long

    console = Console(stderr=True, emoji=False)
    shown = _bar(title, console) if console.is_terminal else _lines(title)
    with telling(title), shown as report:
        yield report


@contextmanager
def _bar(title: str, console: Any) -> Iterator[Progress]:
    """Show a bar if the work lasts."""
    from rich.progress import (
        BarColumn,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )
    from rich.progress import (
        Progress as Bar,
    )

    bar = Bar(
        TextColumn("{task.description}"),
        BarColumn(bar_width=20),
        TextColumn("{task.fields[share]}"),
        TimeElapsedColumn(),
        TextColumn("{task.fields[left]}"),
        TimeRemainingColumn(),
        console=console,
        transient=True,
    )
    task = bar.add_task(title, total=None, share="", left="")  # how much it is, is not known yet

    def advance(fraction: float) -> None:
        share = f"{100 * fraction:3.0f} %"
        bar.update(task, total=1.0, completed=fraction, share=share, left="left")

    timer = Timer(PATIENCE, bar.start)
    timer.daemon = True
    timer.start()
    try:
        yield advance
    finally:
        timer.cancel()
        timer.join()
        bar.stop()


@contextmanager
def _lines(title: str) -> Iterator[Progress]:
    """Print lines while the work lasts; yield a function that takes the fraction."""
    begun, done = monotonic(), [0.0]
    first: list[tuple[float, float]] = []  # the first fraction, and when it was reported

    def report(fraction: float) -> None:
        if fraction > 0.0 and not first:
            first.append((fraction, monotonic() - begun))
        done[0] = fraction

    def tell() -> None:
        since = first[0] if first else (0.0, 0.0)
        print_line(line(title, done[0], monotonic() - begun, since))

    with now_and_then(tell):
        yield report


@contextmanager
def now_and_then(tell: Callable[[], None]) -> Iterator[None]:
    """Call a function while the work lasts: after some seconds, and then after longer pauses."""
    finished = Event()

    def beat() -> None:
        pause = FIRST_LINE
        while not finished.wait(pause):
            tell()
            pause = min(2.0 * pause, EVERY)

    teller = Thread(target=beat, daemon=True)
    teller.start()
    try:
        yield
    finally:
        finished.set()
        teller.join()


def line(
    title: str, fraction: float, seconds: float, since: tuple[float, float] = (0.0, 0.0)
) -> str:
    """Return the progress in words; the time left is that at the pace since a fraction and a time.

    What comes before the first fraction, such as compilation, comes once. The time left is not said
    where that pace is known for a short while only, or little is done.

    Examples
    --------
    >>> line("simulating", 0.25, 40.0)
    'simulating: 25 % after 40 s, about 2 min left'
    >>> line("simulating", 0.0, 5.0)
    'simulating: begun 5 s ago'
    """
    if fraction <= 0.0:
        return f"{title}: begun {in_time(seconds)} ago"
    done, spent = fraction - since[0], seconds - since[1]
    known = fraction >= BEGUN and done > 0.0 and spent > WATCHED * seconds
    left = f", about {in_time(spent * (1.0 - fraction) / done)} left" if known else ""
    return f"{title}: {100 * fraction:.0f} % after {in_time(seconds)}{left}"


def in_time(seconds: float) -> str:
    """Return a time for a sentence: in seconds below a minute, else in minutes or hours."""
    if seconds < 60.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 3600.0 else f"{seconds / 3600.0:.1f} h"


def print_line(text: str) -> None:
    """Print a line of progress; nobody may read it."""
    with suppress(OSError, ValueError, AttributeError):  # closed, or none
        print(text, file=sys.stderr, flush=True)
