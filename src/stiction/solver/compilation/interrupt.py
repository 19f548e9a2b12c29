"""Delay of interrupts and of the search for garbage while code is compiled, loaded or run."""

from __future__ import annotations

import gc
import signal
import threading

# what signal.signal wraps; the wrapper seeks a name for each handler, 15 us of a call's 85
from _signal import signal as set_handler  # type: ignore[import-not-found]
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from stiction.solver.compilation.turn import end_turns

_counting = threading.Lock()
_paused: list[bool] = []  # whether garbage was sought before, then one for each that compiles
MANY = 50_000  # objects: compiling makes 100 000 and more, loading machine code some 20 000


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

    before = set_handler(signal.SIGINT, note)
    try:
        yield
    finally:
        set_handler(signal.SIGINT, before if before is not None else signal.SIG_DFL)
        if arrived:
            signal.raise_signal(signal.SIGINT)


@contextmanager
def compiling() -> Iterator[None]:
    """Delay an interrupt until the block ends, and the search for garbage too; then end all turns.

    Half of what numba allocates lives until the end; to look through it again and again would take
    a tenth of the time.
    """
    with delay_interrupt():
        pause_search()
        try:
            yield
        finally:
            end_turns()
            resume_search()


def pause_search() -> None:
    """Search for no garbage until all threads that compile have ended.

    Each by itself would find the search paused by another, and leave it so for good.
    """
    with _counting:
        if not _paused:
            _paused.append(gc.isenabled())
        _paused.append(True)
        gc.disable()


def resume_search() -> None:
    """Search for garbage again, if nothing else compiles and it was sought before."""
    with _counting:
        _paused.pop()
        if len(_paused) > 1 or not _paused.pop():
            return
        if gc.get_count()[0] > MANY and not gc.get_freeze_count():
            gc.freeze()  # all is old now: else all would be looked through at once
            gc.unfreeze()
        gc.enable()
