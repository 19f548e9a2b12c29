"""What this machine lends: how many cores, and how much memory.

What takes more memory is refused before it is asked for.
"""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path

try:
    import resource
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]

# of those that this process may use: a batch system lends some of the machine's
CORES = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
SHARE = 0.5  # of the memory, to one thing: the rest is for copies of it, and for others
UNKNOWN = 8e9  # bytes, where the machine does not say
LIMITS = (  # of a container or a batch system
    Path("/sys/fs/cgroup/memory.max"),
    Path("/sys/fs/cgroup/memory/memory.limit_in_bytes"),
)


@cache
def lent() -> float:
    """Return how many bytes one thing may take."""
    return SHARE * min(_physical(), *map(_limit, LIMITS), _of_process())


def shortage(size: float) -> str:
    """Return what is said of something that takes `size` bytes; '' if there is room for it."""
    if size <= lent():
        return ""
    return f"takes {size / 1e9:.3g} GB of memory, and this machine lends {lent() / 1e9:.3g} GB"


def _physical() -> float:
    try:
        return float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (AttributeError, OSError, ValueError):
        return UNKNOWN


def _limit(file: Path) -> float:
    try:
        return float(file.read_text())  # "max" where there is none
    except (OSError, ValueError):
        return float("inf")


def _of_process() -> float:
    if resource is None:
        return float("inf")
    soft, _ = resource.getrlimit(resource.RLIMIT_AS)
    return float("inf") if soft == resource.RLIM_INFINITY else float(soft)
