"""Notices of the package, such as compilation, printed to standard error."""

from __future__ import annotations

import logging

from rich.console import Console


class Notices(logging.Handler):
    """Print each notice on its own line, above any progress bar."""

    def emit(self, record: logging.LogRecord) -> None:
        """Print a notice."""
        console = Console(stderr=True, soft_wrap=True, emoji=False)  # on the present standard error
        console.print(record.getMessage(), markup=False, highlight=False)


def show_notices() -> None:
    """Show notices from now on."""
    log = logging.getLogger("stiction")
    if not any(isinstance(each, Notices) for each in log.handlers):
        log.addHandler(Notices())
    log.setLevel(logging.INFO)
