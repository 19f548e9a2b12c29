"""How the solver is compiled, and where the machine code is kept."""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
from numba.core import config
from platformdirs import user_cache_path

from stiction.friction.source import text_of
from stiction.solver.interrupt import uninterrupted

F = TypeVar("F", bound=Callable[..., Any])

# sums may be contracted to fused multiply-adds and divisions by a common divisor shared;
# nothing is reordered, and infinities and NaN keep their meaning
FAST = {"contract", "arcp", "nsz"}


def compiled(function: F) -> F:
    """Compile an entry point: cached on disk, without the GIL."""
    return _kept(function, "")


def inlined(function: F) -> F:
    """Compile a piece of the loop, and have it merged into whatever compiled code calls it.

    Without this the compiler keeps the larger pieces apart and passes their many numbers
    through memory, which takes 1.7 times as long. It is kept on disk as a part of what
    calls it, not by itself.
    """
    return _jit(function, inline=True, keep=False)


def piece(function: F) -> F:
    """Compile a piece of the loop that is called from several places or is large, by itself.

    Only compiled code can call it, and it allocates nothing: without the code for either, arrays
    that are passed on are not counted, and it compiles in a third of the time.
    """
    njit: Any = numba.njit
    made = njit(
        nogil=True,
        error_model="numpy",
        fastmath=FAST,
        no_cpython_wrapper=True,
        no_cfunc_wrapper=True,
        _nrt=False,
    )(function)
    return cast(F, made)


@cache
def specialised(function: Any, *kinds: type) -> Any:
    """Return the compiled `function` to call with arguments of these types.

    The package's own types share one cache. Another law or drive has a cache to itself, named
    after the content of its file: an edit there is seen, and a process that does not know the
    law never meets it. What stands in a prompt or in the script itself is compiled anew in
    each process.
    """
    own = [kind for kind in kinds if not kind.__module__.startswith("stiction.")]
    if not own:
        return function
    try:
        digest = hashlib.sha256("".join(sorted(map(_source, own))).encode())
    except OSError:
        return _jit(function.py_func, inline=False, keep=False)
    return _kept(function.py_func, f"own-{digest.hexdigest()[:16]}")


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


def _kept(function: F, name: str) -> F:
    with _cache_directory(name):
        try:
            return _jit(function, inline=False, keep=True)
        except RuntimeError:  # no directory can be written
            return _jit(function, inline=False, keep=False)


def _jit(function: F, inline: bool, keep: bool) -> F:
    made: Any = numba.njit(
        cache=keep,
        nogil=True,
        error_model="numpy",
        fastmath=FAST,
        forceinline=inline,
    )(function)
    return cast(F, made)


@contextmanager
def _cache_directory(name: str) -> Iterator[None]:
    """Point numba's cache at a writable directory of our own, while a function is decorated."""
    settings: Any = config
    before = settings.CACHE_DIR
    settings.CACHE_DIR = str(_directory() / name)
    try:
        yield
    finally:
        settings.CACHE_DIR = before


@cache
def _directory() -> Path:
    """Return where to keep machine code: below ``NUMBA_CACHE_DIR`` if that is set."""
    name = f"compiled-{_fingerprint()}"
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    fallback = Path(tempfile.gettempdir()) / "stiction"
    for root in (Path(chosen) if chosen else user_cache_path("stiction"), fallback):
        try:
            (root / name).mkdir(parents=True, exist_ok=True)
        except OSError:
            continue
        if os.access(root / name, os.W_OK):
            return root / name
    return fallback / name


@cache
def _fingerprint() -> str:
    """Return a hash of every source file that is compiled.

    numba's cache sees an edit in the file of the compiled function only, not in one that it
    calls; with the fingerprint in the path, any edit leads to a fresh directory.
    """
    package = Path(__file__).parent.parent
    files = [*(package / "drive").glob("*.py"), *(package / "friction").glob("*.py")]
    files += [file for file in (package / "solver").rglob("*.py") if file.stem != "twin"]
    digest = hashlib.sha256()
    for file in sorted(files):
        digest.update(file.read_bytes())
    return digest.hexdigest()[:16]
