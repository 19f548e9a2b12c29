"""Files that a command writes: each is checked before the work, and named once it is written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from stiction.cli.terminal import say
from stiction.errors import Faults


def check_output(
    path: Path | None, faults: Faults, check: Callable[..., object], *options: Any
) -> None:
    """Note a fault of a path to be written, if one is given: where nothing can be written to it."""
    if path is not None:
        with faults.of_part():
            check(path, *options)


def check_figure(path: Path | None, faults: Faults) -> None:
    """Do as `check_output` for a figure."""
    if path is not None:
        from stiction.plotting.page.save import drawable  # slow to import

        check_output(path, faults, drawable)


def write_figure(path: Path, plot: Callable[..., Any], *drawn: Any, **options: Any) -> None:
    """Draw a figure, write it and name its file; a bar is shown while that takes long."""
    from stiction.plotting.page.canvas import figure_of
    from stiction.plotting.page.save import write
    from stiction.progress.display import show_progress

    with show_progress("drawing"):
        written = write(figure_of(plot, *drawn, **options), path)
    say(f"wrote {written}")
