"""Progress bar, with the time left, for work that takes more than a second."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Timer

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

PATIENCE = 1.0  # seconds of silence before a bar appears


@contextmanager
def progress(title: str) -> Iterator[Callable[[float], None]]:
    """Show a bar on standard error after a second; yield a function that takes the fraction."""
    console = Console(stderr=True, emoji=False)
    if not console.is_terminal:
        yield lambda fraction: None
        return
    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(bar_width=20),
        TextColumn("{task.percentage:>3.0f} %"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=console,
        transient=True,
    )
    task = bar.add_task(title, total=1.0)
    timer = Timer(PATIENCE, bar.start)
    timer.daemon = True
    timer.start()
    try:
        yield lambda fraction: bar.update(task, completed=fraction)
    finally:
        timer.cancel()
        timer.join()
        bar.stop()
