"""From the text of a unit, as people write it, to its factor in SI.

Products are written with ``*``, ``·``, ``.`` or a space, quotients with ``/``, powers with ``^``,
``**``, small digits, or digits alone (``m s-1``). Nothing else is evaluated: the registry of units
is asked for names only.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from functools import cache, lru_cache
from typing import Any

from stiction.errors import echo

LONGEST_UNIT = 60  # characters
RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹"  # which are letters to a regular expression, but none of a name
TOKEN = re.compile(
    rf"\s*(?:(?P<name>[^\W\d_{RAISED}][^\W\d{RAISED}]*|°)"
    rf"(?P<power>\s*(?:\*\*|\^)\s*[+-]?\d(?!\d)|[+-]?\d(?!\d)|[⁺⁻]?[{RAISED}])?"
    r"|(?P<one>1)(?=\s*/)|(?P<sign>[*/·⋅×.()]))\s*"
)
SMALL = str.maketrans(f"⁺⁻{RAISED}", "+-0123456789")
# units that the registry misreads or does not know: Ns is not the plural of newton
SPELLED = {"°": ("degree",), "Ns": ("newton", "second"), "Nm": ("newton", "meter")}

# what nearly all descriptions are written in: powers of ten and of the base units of SI
PREFIXES = {"n": -9, "u": -6, "µ": -6, "m": -3, "": 0, "k": 3, "M": 6}
METRIC = {
    "m": {"m": 1},
    "g": {"ten": -3, "kg": 1},
    "t": {"ten": 3, "kg": 1},  # kt is a knot of a speed alone
    "s": {"s": 1},
    "N": {"m": 1, "kg": 1, "s": -2},
    "Hz": {"s": -1},
}
COMMON = {
    prefix + name: {**powers, "ten": powers.get("ten", 0) + ten}
    for prefix, ten in PREFIXES.items()
    for name, powers in METRIC.items()
}
LARGEST_POWER = 60  # of ten; the registry refuses what lies beyond


class UnitError(ValueError):
    """A unit cannot be read; the message says why."""


@cache
def registry() -> Any:
    """Return the registry of units."""
    import pint  # slow to import and only needed where a string is read

    return pint.UnitRegistry()


@lru_cache(maxsize=1024)
def factor(text: str, wanted: str) -> float | None:
    """Return the factor from the unit `text` to the unit `wanted`; None if they do not match.

    A radian counts as a unit: ``rad/s`` does not convert to Hz, which would be off by 2 pi.

    Raises
    ------
    UnitError
        If the text is not a unit.

    Examples
    --------
    >>> factor("N s/m", "N*s/m"), factor("mm s^-1", "m/s"), factor("rad/s", "Hz")
    (1.0, 0.001, None)
    """
    if (metric := _metric_factor(text, wanted)) is not None:
        return metric
    try:
        one, other = (
            registry().Quantity(1.0, plain(each)).to_root_units() for each in (text, wanted)
        )
    except Exception as error:  # whatever the registry raises: logarithmic units, "nan"
        if isinstance(error, UnitError):
            raise
        raise UnitError(f"{echo(text)} is not a unit that can be converted") from error
    return float(one.magnitude / other.magnitude) if one.units == other.units else None


def _metric_factor(text: str, wanted: str) -> float | None:
    """Return the factor between two products of common units; None if the registry is needed.

    The registry knows them too, but takes a quarter of a second to read its own definitions.
    """
    if len(text) > LONGEST_UNIT:
        return None
    total: Counter[str] = Counter()
    for sign, each in ((1, text), (-1, wanted)):
        for name, power in _product(_tokens(each), each, closing="").items():
            if name not in COMMON:
                return None
            for base, exponent in COMMON[name].items():
                total[base] += sign * power * exponent
    ten = total.pop("ten")
    return None if any(total.values()) or abs(ten) > LARGEST_POWER else float(f"1e{ten}")


def short(text: str) -> str:
    """Return a unit in its short form, e.g. ``N·s/m``; micro is a sign of its own, not a letter."""
    return f"{registry().Unit(plain(text)):~P}".replace("μ", "µ")  # pint 0.26 writes the letter


def plain(text: str) -> str:
    """Return a unit as a product of whole powers of names, or refuse it."""
    if len(text) > LONGEST_UNIT:
        raise UnitError(f"it is longer than {LONGEST_UNIT} characters")
    tokens = _tokens(text)
    powers = _product(tokens, text, closing="")
    for name in powers:
        if name not in registry():
            raise UnitError(f"{echo(name)} is not a known unit (capitals matter)")
    return " * ".join(f"{name}**{power}" for name, power in powers.items())


def _tokens(text: str) -> Iterator[re.Match[str]]:
    at = 0
    while at < len(text):
        token = TOKEN.match(text, at)
        if token is None:
            raise UnitError(f"{text[at:].strip()[:20]!r} is not a unit")
        at = token.end()
        yield token


def _product(tokens: Iterator[re.Match[str]], text: str, closing: str) -> Counter[str]:
    """Return the power of each name in a product, to the end or to the closing bracket."""
    powers: Counter[str] = Counter()
    sign = ""  # the sign before the next factor; '' for a space
    divided = wanted = False  # whether a quotient has begun; whether a factor must follow
    for token in tokens:
        if token["sign"] == ")" and closing and not wanted:
            return powers
        if token["sign"] and token["sign"] != "(":
            if token["sign"] == ")" or wanted or (not powers and token["sign"] != "/"):
                raise UnitError(f"{echo(token['sign'])} is in the place of a unit")
            sign, wanted = token["sign"], True
            continue
        if divided and sign not in ("/", "*"):
            raise UnitError("the denominator after '/' is ambiguous; put it in brackets")
        inner = _product(tokens, text, ")") if token["sign"] else _factor(token)
        for name, power in inner.items():
            powers[name] += -power if sign == "/" else power
        divided, sign, wanted = divided or sign == "/", "", False
    if closing or wanted:
        raise UnitError("it is incomplete")
    return Counter({name: power for name, power in powers.items() if power})


def _factor(token: re.Match[str]) -> dict[str, int]:
    if token["one"]:
        return {}
    written = (token["power"] or "1").translate(SMALL)
    power = int(re.sub(r"[*^\s]", "", written))
    return dict.fromkeys(SPELLED.get(token["name"], (token["name"],)), power)
