"""What the package notes while it works, such as that it compiles: on standard error."""

from __future__ import annotations

import logging

from rich.console import Console


class Notices(logging.Handler):
    """Print each note on a line of its own, above a progress bar if there is one."""

    def emit(self, record: logging.LogRecord) -> None:
        """Print a note."""
        console = Console(stderr=True, soft_wrap=True)  # of the standard error of this moment
        console.print(record.getMessage(), markup=False, highlight=False)


def show_notices() -> None:
    """Show notes from now on."""
    log = logging.getLogger("stiction")
    if not any(isinstance(each, Notices) for each in log.handlers):
        log.addHandler(Notices())
    log.setLevel(logging.INFO)
