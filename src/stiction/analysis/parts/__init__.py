"""The parts of an analysis, in the order of its report: each has one file, and one line here.

A part has some of four functions, which take the `Analysis`: ``find`` returns what the part adds
to it (or raises the reason why not), ``section`` tells it, ``tables`` and ``numbers`` store it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from stiction.names import entry

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis

PARTS = (
    "brief",
    "procedure",
    "motion",
    "friction",
    "changes",
    "cycles",
    "creep",
    "rotation",
    "oscillation",
    "energy",
    "metadata",
)


def functions(name: str) -> Iterator[tuple[str, Callable[[Analysis], Any]]]:
    """Return each part that has a function of this name, and the function."""
    for part in PARTS:
        function = getattr(entry(__name__, part, None, "PARTS"), name, None)
        if function is not None:
            yield part, function
