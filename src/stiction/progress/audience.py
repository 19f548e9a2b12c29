"""The audience of progress reports: a user who waits for long work."""

from __future__ import annotations

import builtins
import logging
import sys
from collections.abc import Callable
from contextlib import ExitStack
from functools import wraps
from inspect import signature
from multiprocessing import parent_process
from threading import current_thread, main_thread
from time import monotonic
from typing import ParamSpec, TypeVar

from stiction.progress import display
from stiction.progress.report import Progress

Arguments = ParamSpec("Arguments")
Returned = TypeVar("Returned")

SHORT = 0.1  # seconds; shorter work needs no display, which takes 0.2 ms to begin


def with_progress(
    title: str, told_by: Callable[[Progress], Callable[..., None]] = lambda progress: progress
) -> Callable[[Callable[Arguments, Returned]], Callable[Arguments, Returned]]:
    """Decorate a function of `progress`, which is shown to a user who waits and has given none.

    Part of other work tells nothing of its own. `told_by` makes from a function of the fraction
    done what the decorated one calls.
    """

    def decorate(function: Callable[Arguments, Returned]) -> Callable[Arguments, Returned]:
        parameters = signature(function)

        @wraps(function)
        def call(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Returned:
            if display.told or not somebody_waits():
                return function(*args, **kwargs)
            try:
                given = parameters.bind(*args, **kwargs).arguments
            except TypeError:  # it says what is wrong
                return function(*args, **kwargs)
            with display.telling(title), ExitStack() as shown:
                if given.get("progress") is None:
                    given["progress"] = told_by(_from_first_report(title, shown))
                return function(**given)  # type: ignore[call-arg]

        return call

    return decorate


def _from_first_report(title: str, shown: ExitStack) -> Progress:
    """Return a report that shows progress from its first call on after `SHORT`."""
    reports: list[Progress] = []
    begun = monotonic()

    def report(fraction: float) -> None:
        if not reports and monotonic() - begun > SHORT:
            reports.append(shown.enter_context(display.show_progress(title)))
        for each in reports:
            each(fraction)

    return report


def somebody_waits() -> bool:
    """Return whether a user waits, at a terminal or in a notebook, and has set no level of the log.

    Scripts that run by themselves, other threads and processes stay silent.
    """
    if current_thread() is not main_thread() or parent_process() is not None:
        return False
    if logging.getLogger("stiction").level:
        return False
    return hasattr(builtins, "__IPYTHON__") or (sys.stderr is not None and sys.stderr.isatty())
