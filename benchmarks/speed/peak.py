"""The peak memory of this process."""

from __future__ import annotations

import sys
from pathlib import Path

STATUS = Path("/proc/self/status")


def peak() -> int:
    """Return the peak resident set, in bytes.

    On Linux `getrusage` counts what the process was forked from as well, so it is read where the
    system says it of this program alone; elsewhere it counts kibibytes, but for macOS.
    """
    if STATUS.exists():
        line = next(each for each in STATUS.read_text().splitlines() if each.startswith("VmHWM"))
        return 1024 * int(line.split()[1])
    import resource

    return (1 if sys.platform == "darwin" else 1024) * resource.getrusage(
        resource.RUSAGE_SELF
    ).ru_maxrss
