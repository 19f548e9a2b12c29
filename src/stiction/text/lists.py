"""Lists in sentences: of texts, of reasons and where they hold, and numbers that may be missing."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import isnan

LISTED = 3  # texts that a sentence lists


def in_list(texts: Sequence[str]) -> str:
    """Return the first few of some texts in a row, and the number of the others.

    >>> in_list(["1 s", "2 s"]), in_list(["1 s", "2 s", "3 s", "4 s", "5 s"])
    ('1 s, 2 s', '1 s, 2 s, 3 s and 2 more')
    """
    more = len(texts) - LISTED
    return ", ".join(texts[:LISTED]) + (f" and {more} more" if more > 0 else "")


def number_text(value: float, spec: str) -> str:
    """Return a number as text, formatted so; "none" if it is NaN."""
    return "none" if isnan(value) else format(value, spec)


def say_left_out(faults: Iterable[tuple[str, str]]) -> tuple[str, ...]:
    """Return a sentence for each reason why something is left out: of all (where, why).

    >>> say_left_out([("1 s", "Too short"), ("2 s", "No load"), ("3 s", "Too short")])
    ('Too short: left out at 1 s, 3 s.', 'No load: left out at 2 s.')
    """
    places: dict[str, list[str]] = {}
    for where, why in faults:
        places.setdefault(why, []).append(where)
    return tuple(f"{why}: left out at {in_list(where)}." for why, where in places.items())
