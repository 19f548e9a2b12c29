"""Lists in sentences: of texts, of reasons and where they hold, and numbers that may be missing."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import isnan

LISTED = 3  # texts that a sentence lists


def in_list(texts: Sequence[str]) -> str:
    """Return the first few of some texts in a row, and the number of the others."""
    more = len(texts) - LISTED
    return ", ".join(texts[:LISTED]) + (f" and {more} more" if more > 0 else "")


def number_text(value: float, spec: str) -> str:
    """Return a number as text, formatted so; "none" if it is NaN."""
    return "none" if isnan(value) else format(value, spec)


def say_left_out(faults: Iterable[tuple[str, str]]) -> tuple[str, ...]:
    """Return a sentence for each reason why something is left out: of all (where, why)."""
    places: dict[str, list[str]] = {}
    for where, why in faults:
        places.setdefault(why, []).append(where)
    return tuple(f"{why}: left out at {in_list(where)}." for why, where in places.items())
