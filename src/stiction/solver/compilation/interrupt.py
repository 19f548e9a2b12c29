"""Ctrl-C while compiled code runs."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def delay_interrupt() -> Iterator[None]:
    """Delay an interrupt until the block ends.

    An interrupt would crash the interpreter if it arrived while numba turns a result into Python
    objects by running Python code. Python interrupts only the main thread; in other threads this
    does nothing. At the end the usual handler of interrupts runs, if any: under nohup they stay
    ignored.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    arrived: list[int] = []

    def note(number: int, _: Any) -> None:
        arrived.append(number)

    before = signal.signal(signal.SIGINT, note)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before if before is not None else signal.SIG_DFL)
        if arrived:
            signal.raise_signal(signal.SIGINT)
