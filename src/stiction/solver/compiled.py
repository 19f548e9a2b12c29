"""How the solver is compiled."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import cache
from typing import Any, TypeVar, cast

import numba

from stiction.friction.source import text_of
from stiction.solver.interrupt import uninterrupted
from stiction.solver.machine_code import Shelf

njit: Any = numba.njit
F = TypeVar("F", bound=Callable[..., Any])

# sums may be contracted to fused multiply-adds and divisions by a common divisor shared;
# nothing is reordered, and infinities and NaN keep their meaning
ARITHMETIC = {"error_model": "numpy", "fastmath": {"contract", "arcp", "nsz"}}

# only compiled code calls a part, and most allocate nothing: without the code for Python callers
# and for counting references they compile in half the time
PART = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def compiled(function: F) -> F:
    """Compile an entry point, which Python calls: kept on disk, without the GIL."""
    return _entry(function, Shelf(function))


def inlined(function: F) -> F:
    """Compile a part of the loop, and have it merged into whatever compiled code calls it.

    Without this the compiler keeps the larger parts apart and passes their many numbers
    through memory, which takes 1.7 times as long.
    """
    return _part(function, forceinline=True, _nrt=False)


def allocating(function: F) -> F:
    """Compile a part of the loop that makes arrays, which are counted."""
    return _part(function)


def piece(function: F) -> F:
    """Compile a part of the loop that is called from several places or is large, by itself."""
    return _part(function, _nrt=False)


def _part(function: F, **options: bool) -> F:
    made: Any = njit(nogil=True, **options, **ARITHMETIC, **PART)(function)

    def refuse(*_: Any, **__: Any) -> Any:
        raise TypeError(f"{function.__name__} is called by compiled code only")

    # numba would call code that is not there, and Python would crash
    made._insert, made._compile_for_args = _nowhere, refuse
    return cast(F, made)


def _nowhere(*_: Any, **__: Any) -> None:
    """Enter a compiled part among what Python can call: not at all."""


def _entry(function: F, shelf: Shelf | None) -> F:
    made: Any = njit(nogil=True, **ARITHMETIC)(function)
    if shelf is not None:
        made._cache = shelf
    return cast(F, made)


@cache
def specialised(function: Any, *kinds: type) -> Any:
    """Return the compiled `function` to call with arguments of these types.

    Code for another law or drive than the package's own is kept under the content of its file: an
    edit there is seen, and a process that does not know the law never meets it. What stands in a
    prompt or in the script itself is compiled anew in each process.
    """
    own = [kind for kind in kinds if not kind.__module__.startswith("stiction.")]
    if not own:
        return function
    try:
        digest = hashlib.sha256("".join(sorted(map(_source, own))).encode())
    except OSError:
        return _entry(function.py_func, None)
    return _entry(function.py_func, Shelf(function.py_func, digest.hexdigest()))


_met: set[tuple[Any, ...]] = set()


def called(function: Any, kinds: tuple[type, ...], *arguments: Any) -> Any:
    """Call what `specialised` returns; what it returns must be made of plain tuples and numbers.

    The first time it is compiled, or loaded, which no interrupt may cut short: numba would be left
    with half of its parts in place, and this process could compile nothing more.
    """
    solve = specialised(function, *kinds)
    if (solve, kinds) in _met:
        return solve(*arguments)
    with uninterrupted():
        found = solve(*arguments)
        _met.add((solve, kinds))
    return found


def _source(kind: type) -> str:
    """Return what to name a type's cache after: its text, and its module, by which it is kept."""
    text = None if kind.__module__ == "__main__" else text_of(kind)
    if text is None:  # in a script its types are new ones in each process
        raise OSError(f"{kind.__module__} has no file, as it was run, to name them by")
    return f"{kind.__module__}\n{text.text}"
