"""How the solver is compiled, and where the machine code is kept."""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import numba
from numba.core import config
from platformdirs import user_cache_path

F = TypeVar("F", bound=Callable[..., Any])

# sums may be contracted to fused multiply-adds and divisions by a common divisor shared;
# nothing is reordered, and infinities and NaN keep their meaning
FAST = {"contract", "arcp", "nsz"}


def compiled(function: F) -> F:
    """Compile an entry point: cached on disk, without the GIL."""
    return _compile(function, inline=False)


def inlined(function: F) -> F:
    """Compile a piece of the loop, and have it merged into whatever compiled code calls it.

    Without this the compiler keeps the larger pieces apart and passes their many numbers
    through memory, which takes 1.7 times as long.
    """
    return _compile(function, inline=True)


def _compile(function: F, inline: bool) -> F:
    def jit(keep: bool) -> F:
        made: F = numba.njit(
            cache=keep, nogil=True, error_model="numpy", fastmath=FAST, forceinline=inline
        )(function)
        return made

    with _cache_directory():
        try:
            return jit(True)
        except RuntimeError:  # no directory can be written
            return jit(False)


@contextmanager
def _cache_directory() -> Iterator[None]:
    """Point numba's cache at a writable directory of our own, unless the user chose one."""
    if os.environ.get("NUMBA_CACHE_DIR"):
        yield
        return
    before = config.CACHE_DIR
    config.CACHE_DIR = str(_directory())
    try:
        yield
    finally:
        config.CACHE_DIR = before


@cache
def _directory() -> Path:
    name = f"compiled-{_fingerprint()}"
    for root in (user_cache_path("stiction"), Path(tempfile.gettempdir()) / "stiction"):
        try:
            (root / name).mkdir(parents=True, exist_ok=True)
        except OSError:
            continue
        if os.access(root / name, os.W_OK):
            return root / name
    return root / name


@cache
def _fingerprint() -> str:
    """Return a hash of every source file that is compiled.

    numba's cache sees an edit in the file of the compiled function only, not in one that it
    calls; with the fingerprint in the path, any edit leads to a fresh directory.
    """
    package = Path(__file__).parent.parent
    files = [package / "drive.py", *(package / "friction").glob("*.py")]
    files += (package / "solver").glob("*.py")
    digest = hashlib.sha256()
    for file in sorted(files):
        digest.update(file.read_bytes())
    return digest.hexdigest()[:16]
