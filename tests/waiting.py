"""Waiting for events of another process, however long a busy machine takes."""

import time
from collections.abc import Callable

# a shell has what it runs in the background ignore interrupts, and so do its children
INTERRUPTIBLE = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
PATIENCE = 1800.0  # s; ends what would hang for ever, and decides nothing else


def until(happened: Callable[[], bool], what: str = "it") -> None:
    """Wait until something has happened; `what` is named if it never does."""
    end = time.monotonic() + PATIENCE
    while not happened():
        assert time.monotonic() < end, f"{what} hangs"
        time.sleep(0.01)
