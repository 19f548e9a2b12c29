"""How the solver is compiled; with NUMBA_DISABLE_JIT=1 it runs as the Python that it is.

That takes some 200 times as long, and is for debuggers and for `benchmarks.mutation`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

from stiction.solver.compilation.interrupt import uninterrupted
from stiction.solver.compilation.machine_code import Shelf

njit: Any = numba.njit
config: Any = numba.config
F = TypeVar("F", bound=Callable[..., Any])

INTERPRETED = bool(config.DISABLE_JIT)

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


def uncompiled(function: F) -> F:
    """Return the Python function of a compiled one."""
    return cast(F, getattr(function, "py_func", function))


def _part(function: F, **options: bool) -> F:
    if INTERPRETED:
        return function
    made: Any = njit(nogil=True, **options, **ARITHMETIC, **PART)(function)

    def refuse(*_: Any, **__: Any) -> Any:
        raise TypeError(f"{function.__name__} is called by compiled code only")

    # numba would call code that is not there, and Python would crash
    made._insert, made._compile_for_args = _nowhere, refuse
    return cast(F, made)


def _nowhere(*_: Any, **__: Any) -> None:
    """Enter a compiled part among what Python can call: not at all."""


def compiled_for(function: Any, digest: str | None) -> Any:
    """Return a function of `compiled` for what is not the package's own, kept under its digest.

    None is for what has no text to tell it by: that is compiled anew in each process.
    """
    own = uncompiled(function)
    return _entry(own, None if digest is None else Shelf(own, digest))


def _entry(function: F, shelf: Shelf | None) -> F:
    if INTERPRETED:
        return function
    made: Any = njit(nogil=True, **ARITHMETIC)(function)
    if shelf is not None:
        made._cache = shelf
    return cast(F, made)


_met: set[tuple[Any, ...]] = set()


def called(function: Any, kinds: tuple[type, ...], *arguments: Any) -> Any:
    """Call a compiled function; what it returns must be made of plain tuples and numbers.

    The first time for arguments of these types it is compiled, or loaded, which no interrupt may
    cut short: numba would be left with half of its parts in place, and this process could compile
    nothing more.
    """
    if (function, kinds) in _met:
        return function(*arguments)
    with uninterrupted():
        found = function(*arguments)
        _met.add((function, kinds))
    return found
