"""Compilation of the solver; with NUMBA_DISABLE_JIT=1 it runs as plain Python.

Plain Python takes some 200 times as long; it serves debuggers and `benchmarks.mutation`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
import numpy as np

from stiction.solver.compilation.interrupt import compiling
from stiction.solver.compilation.machine_code import Shelf
from stiction.solver.compilation.part import make_entry, make_part

config: Any = numba.config
F = TypeVar("F", bound=Callable[..., Any])

INTERPRETED = bool(config.DISABLE_JIT)


def number(value: int) -> int:
    """Return a constant to call a part with, for which numba does not compile it anew."""
    return value if INTERPRETED else cast(int, np.int64(value))


def switch(value: bool) -> bool:
    """Return True or False to call a part with, for which numba does not compile it anew."""
    return value if INTERPRETED else cast(bool, np.bool_(value))


def compiled(function: F) -> F:
    """Compile an entry point that Python calls, cached on disk, without the GIL.

    It must make no arrays: numba's count of references to them takes each process 20 ms to compile.
    """
    return _entry(function, Shelf(function, counts=False))


def compiled_with_arrays(function: F) -> F:
    """Compile an entry point that Python calls, as `compiled` does, which may make arrays."""
    return _entry(function, Shelf(function))


def entry_by_address(*kinds: Any) -> Callable[[F], F]:
    """Compile an entry point that compiled code calls by its address, cached on disk.

    `kinds` are the types of its arguments after the first, a law (see `pointer`). Our laws make no
    arrays, and keep none: to count references to them takes longer than most laws.
    """

    def compile_entry(function: F) -> F:
        made: Any = _entry(function, Shelf(function, counts=False), no_cfunc_wrapper=True)
        made.kinds = kinds
        return cast(F, made)

    return compile_entry


def inlined(function: F) -> F:
    """Compile a part of the loop, inlined into the compiled code that calls it.

    Otherwise the compiler keeps larger parts separate and passes their many numbers through memory,
    which takes 1.7 times as long.
    """
    return _part(function, forceinline=True, _nrt=False)


def piece(function: F) -> F:
    """Compile a part separately because it is large or called from several places.

    numba would otherwise inline it wherever an `inlined` part calls it.
    """
    return _part(function, forceinline=False, _nrt=False)


def python_of(function: F) -> F:
    """Return the Python function of a compiled one."""
    return cast(F, getattr(function, "py_func", function))


def _part(function: F, **options: Any) -> F:
    return function if INTERPRETED else cast(F, make_part(function, **options))


def compiled_for(function: Any, digest: str | None) -> Any:
    """Return a `compiled` function for types of a user's law, cached under its digest.

    Such a law may make arrays, so that references to them are counted.
    The digest is None if the law's text is unknown; then each process compiles it anew.
    """
    own = python_of(function)
    return _entry(own, None if digest is None else Shelf(own, digest))


def _entry(function: F, shelf: Shelf | None, **options: Any) -> F:
    if INTERPRETED:
        return function
    made = make_entry(function, _nrt=shelf is None or shelf.counts, **options)
    if shelf is not None:
        made._cache = shelf
    return cast(F, made)


_met: set[tuple[Any, ...]] = set()


def call_compiled(function: Any, kinds: tuple[type, ...], *arguments: Any) -> Any:
    """Call a compiled function that returns plain tuples and numbers.

    The first call with arguments of these types compiles or loads it. No interrupt may cut this
    short: numba would keep half of the parts, and this process could not compile any more.
    """
    if (function, kinds) in _met:
        return function(*arguments)
    with compiling():
        found = function(*arguments)
        _met.add((function, kinds))
    return found


_entries: dict[tuple[Any, ...], Any] = {}


def call_directly(function: Any, kinds: tuple[type, ...], *arguments: Any) -> Any:
    """Do as `call_compiled`, but find the machine code once.

    In each call numba looks at the types of all arguments, down to each array's order in memory,
    8 us of 10. Here the `kinds` must determine these.
    """
    entry = _entries.get((function, kinds))
    if entry is not None:
        return entry(*arguments)
    found = call_compiled(function, kinds, *arguments)
    _entries[function, kinds] = function if INTERPRETED else entry_point_of(function, arguments)
    return found


def entry_point_of(function: Any, arguments: tuple[Any, ...]) -> Any:
    """Return the machine code for such arguments, or the function where numba converts them."""
    made = function.overloads.get(tuple(map(numba.typeof, arguments)))
    return function if made is None else made.entry_point
