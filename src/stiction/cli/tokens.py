"""Words of the command line before they are read: quantities below zero."""

from __future__ import annotations

import re
from collections.abc import Iterable

NEGATIVE = re.compile(r"-\s*[.,]?\d")  # options begin with letters
OPTION = re.compile(r"--[a-z][\w-]*")
END_OF_OPTIONS = "--"


def join_negative_values(words: Iterable[str]) -> list[str]:
    """Return words with a negative quantity joined to the option before it, by an equals sign.

    The library takes a word that begins with a hyphen for an option, plain numbers aside.

    Examples
    --------
    >>> join_negative_values(["analyse", "data.csv", "--zero", "-3 mN", "--mass", "1 kg"])
    ['analyse', 'data.csv', '--zero=-3 mN', '--mass', '1 kg']
    """
    found: list[str] = []
    for word in words:
        after_option = bool(found) and OPTION.fullmatch(found[-1]) is not None
        if after_option and END_OF_OPTIONS not in found and is_negative(word):
            found[-1] += f"={word}"
        else:
            found.append(word)
    return found


def is_negative(word: str) -> bool:
    """Return whether a word is a quantity below zero, and not an option.

    Examples
    --------
    >>> is_negative("-3mN"), is_negative("-.5 N"), is_negative("-o"), is_negative("--mass")
    (True, True, False, False)
    """
    return NEGATIVE.match(word) is not None
