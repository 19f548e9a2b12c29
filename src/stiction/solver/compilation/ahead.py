"""Compilation of the next function in a second process, while this one compiles another.

The code goes the usual way, over the cache on disk. Nothing depends on the second process: what it
does not leave there is compiled here.
"""

from __future__ import annotations

import atexit
import pickle
import sys
from collections.abc import Callable
from contextlib import suppress
from importlib import import_module
from subprocess import Popen
from typing import Any

from stiction.machine import CORES, python
from stiction.solver.compilation.interrupt import compiling
from stiction.solver.compilation.jit import INTERPRETED

_begun: list[Popen[bytes]] = []


def is_compiled(function: Any, kinds: tuple[Any, ...]) -> bool:
    """Return whether a `compiled` function is ready for arguments of some types, or on disk."""
    return INTERPRETED or kinds in function.overloads or function._cache.holds(kinds)


def compile_beside(function: Any, kinds: tuple[Any, ...]) -> Callable[[], object]:
    """Begin to compile a `compiled` function for some types; return a function that waits.

    On a single core nothing is begun.
    """
    if CORES < 2:
        return lambda: None
    made = function.py_func
    task = pickle.dumps((made.__module__, made.__qualname__, kinds))
    try:
        begun = python(__name__)
    except OSError:
        return lambda: None
    _begun.append(begun)
    assert begun.stdin is not None
    with suppress(OSError), begun.stdin as given:
        given.write(task)
    return begun.wait


@atexit.register
def end() -> None:
    """End the second processes."""
    for begun in _begun:
        begun.kill()
        begun.wait()


def main() -> None:
    """Compile the functions named on standard input."""
    module, name, kinds = pickle.load(sys.stdin.buffer)
    with compiling():
        getattr(import_module(module), name).compile(kinds)


if __name__ == "__main__":
    main()
