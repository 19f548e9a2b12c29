"""Lists in sentences: of texts, of reasons and where they hold, and numbers that may be missing."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import inf, isnan

from stiction.text.quantity.wording import first_decimal

LISTED = 3  # texts that a sentence lists
DECIMALS = 4  # of a coefficient, at most


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


def coefficient_texts(value: float, error: float, sign: str = "") -> tuple[str, str]:
    """Return a coefficient to the first digit of its standard error, and that error as text.

    Each has four decimals at most: of an error that these do not show, only that is said.

    >>> coefficient_texts(0.01693, 0.0021), coefficient_texts(0.01693, 6e-7)
    (('0.017', '0.002'), ('0.0169', '< 0.0001'))
    >>> coefficient_texts(0.01693, float("nan"), "+"), coefficient_texts(-0.004, 0.0)
    (('+0.0169', 'none'), ('-0.0040', '0'))
    """
    places = DECIMALS
    if 0.0 < error < inf:
        places = min(max(first_decimal(error), 0), DECIMALS)
    least = 0.1**DECIMALS
    off = f"< {least:.{DECIMALS}f}" if 0.0 < error < 0.5 * least else number_text(error, ".1g")
    return number_text(value, f"{sign}.{places}f"), off


def say_left_out(faults: Iterable[tuple[str, str]]) -> tuple[str, ...]:
    """Return a sentence for each reason why something is left out: of all (where, why).

    >>> say_left_out([("1 s", "Too short"), ("2 s", "No load"), ("3 s", "Too short")])
    ('Too short: left out at 1 s, 3 s.', 'No load: left out at 2 s.')
    """
    places: dict[str, list[str]] = {}
    for where, why in faults:
        places.setdefault(why, []).append(where)
    return tuple(f"{why}: left out at {in_list(where)}." for why, where in places.items())
