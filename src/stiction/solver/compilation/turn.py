"""Turns of compilation: one process compiles a code, the others wait and load it from disk.

The lock is a byte in a file of the cache's folder, which the system gives back when a process ends.
Where a file cannot be locked, every process compiles for itself.
"""

from __future__ import annotations

import os
import time
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

LONGEST_WAIT = 300.0  # s: then a process compiles beside the other, which may hang
PAUSE = 0.02  # s between two looks

_taken: dict[Path, int] = {}  # file of code, and byte of its lock
_locks: dict[Path, int] = {}  # folder, and descriptor of its lock file: closing it frees all locks


def take_turn(code: Path) -> None:
    """Return once this process may compile the code for a file, or another has written the file."""
    end = time.monotonic() + LONGEST_WAIT
    while not code.exists() and not _lock(code) and time.monotonic() < end:
        time.sleep(PAUSE)


def end_turns() -> None:
    """Let others have all that this process has taken."""
    while _taken:
        code, byte = _taken.popitem()
        fcntl.lockf(_locks[code.parent], fcntl.LOCK_UN, 1, byte)


def _lock(code: Path) -> bool:
    """Lock the byte of a file of code; return False if another process has it."""
    if fcntl is None or code in _taken:
        return True
    byte = int(code.stem[-7:], 16)  # of the digest in its name
    try:
        if code.parent not in _locks:
            _locks[code.parent] = os.open(code.parent / "turns", os.O_RDWR | os.O_CREAT, 0o600)
    except OSError:  # no files here
        return True
    try:
        fcntl.lockf(_locks[code.parent], fcntl.LOCK_EX | fcntl.LOCK_NB, 1, byte)
    except (BlockingIOError, PermissionError):  # another process has it
        return False
    except OSError:  # no locks here
        return True
    _taken[code] = byte
    return True
