"""Detection of endless loops in a user's friction law, before it is compiled.

Its methods run in plain Python for a limited number of lines. Lines are counted, not seconds, so
that the verdict is the same on every machine.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from inspect import isfunction
from math import inf, nan
from types import FrameType
from typing import Any

LINES = 100_000  # a method has about ten
SPEEDS = (0.0, 1e-9, 1e-6, 1e-3, 1.0, inf, nan)  # m/s; the last two may occur in failed steps
LOAD = 1.0  # N


class NoEnd(BaseException):
    """Too many lines were run; a law's `except Exception` does not catch it."""


def endless(law: Any) -> str:
    """Return which method of a law does not end, and at which slip speed; '' for none."""
    for v in SPEEDS:
        for name, call in _calls(law, v).items():
            try:
                with limit_lines(type(law)):
                    call()
            except NoEnd:
                return f"{name} at {v:g} m/s ran {LINES:,} lines and did not end"
            except KeyboardInterrupt:
                raise
            except BaseException:  # other checks report other faults
                continue
    return ""


def _calls(law: Any, v: float) -> dict[str, Callable[[], object]]:
    calls: dict[str, Callable[[], object]] = {"coefficient": lambda: law.coefficient(v)}
    if not hasattr(law, "states"):
        return calls | {"slope": lambda: law.slope(v)}
    return calls | {
        "settled": lambda: law.settled(v),
        "force": lambda: law.force((v, 0.0), LOAD, law.settled(v)),
        "change": lambda: law.change((v, 0.0), LOAD, law.settled(v)),
    }


@contextmanager
def limit_lines(kind: type) -> Iterator[None]:
    """Limit the lines that the methods of a class, and their callees, may run.

    Raises
    ------
    NoEnd
        If they have run `LINES` lines.
    """
    left = LINES

    def count(frame: FrameType, event: str, argument: Any) -> Any:
        nonlocal left
        if frame.f_code.co_filename not in files:
            return None
        left -= 1
        if left < 0:
            raise NoEnd
        return count

    with _in_python(kind) as files:
        before = sys.gettrace()
        sys.settrace(count)
        try:
            yield
        finally:
            sys.settrace(before)


@contextmanager
def _in_python(kind: type) -> Iterator[set[str]]:
    """Run a class's functions as plain Python, not compiled; yield the files they are in."""
    own = [each for each in vars(kind).values() if isfunction(each)]
    methods = [each for each in own if each.__module__ == kind.__module__]  # not tuple's
    names: dict[str, Any] = methods[0].__globals__ if methods else {}
    compiled = {name: value for name, value in names.items() if hasattr(value, "py_func")}
    plain = {name: value.py_func for name, value in compiled.items()}
    names.update(plain)
    try:
        yield {each.__code__.co_filename for each in (*methods, *plain.values())}
    finally:
        names.update(compiled)
