"""Cores and memory that this process may use, and processes beside it.

Work that needs more memory is refused before it starts.
"""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache
from pathlib import Path

try:
    import resource
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]

# a batch system may lend only some of the machine's cores
CORES = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
SHARE = 0.5  # of the memory for one object; the rest is for copies and other programs
UNKNOWN = 8e9  # bytes, where the machine does not tell
LIMITS = (  # files with the limit of a container or batch system
    Path("/sys/fs/cgroup/memory.max"),
    Path("/sys/fs/cgroup/memory/memory.limit_in_bytes"),
)


@cache
def largest_object() -> float:
    """Return how many bytes one object may occupy."""
    return SHARE * min(_physical(), *map(_limit, LIMITS), _of_process())


def shortage(size: float) -> str:
    """Return why `size` bytes are too many, as part of a sentence; '' if they fit."""
    if size <= largest_object():
        return ""
    limit = f"the limit of {largest_object() / 1e9:.3g} GB on this machine"
    return f"takes {size / 1e9:.3g} GB of memory, more than {limit}"


def python(module: str, stdout: int = subprocess.DEVNULL) -> subprocess.Popen[bytes]:
    """Start a module of this package in a second process, which reads its tasks.

    Raises
    ------
    OSError
        If no process can be started.
    """
    return subprocess.Popen(
        [sys.executable, "-P", "-m", module],  # -P: nothing from the working folder
        stdin=subprocess.PIPE,
        stdout=stdout,
        stderr=subprocess.DEVNULL,
        start_new_session=True,  # Ctrl-C is for this process, which ends the other
    )


def _physical() -> float:
    try:
        return float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (AttributeError, OSError, ValueError):
        return UNKNOWN


def _limit(file: Path) -> float:
    try:
        return float(file.read_text())  # ValueError for "max": no limit
    except (OSError, ValueError):
        return float("inf")


def _of_process() -> float:
    if resource is None:
        return float("inf")
    soft, _ = resource.getrlimit(resource.RLIMIT_AS)
    return float("inf") if soft == resource.RLIM_INFINITY else float(soft)
