"""Units as instruments write them: gram-force, volts with a scale, signs, spelt-out names."""

from __future__ import annotations

import re
from math import isclose
from typing import NamedTuple

from stiction.formats.channels import CHANNELS, plain
from stiction.text.quantity.unit import UnitError, factor

GRAVITY = 9.80665  # m/s^2, the standard acceleration of gravity (CGPM 1901): gram-force
MEGA, MEGANEWTONS = 1e6, "meganewtons, a million newtons each; millinewtons are mN"
SPELLED = {
    "sec": "s", "secs": "s", "second": "s", "seconds": "s", "sek": "s", "sekunden": "s",
    "secondes": "s", "segundos": "s", "msec": "ms", "millisec": "ms", "milliseconds": "ms",
    "newton": "N", "newtons": "N", "volt": "V", "volts": "V", "gram": "g", "grams": "g",
    "millinewton": "mN", "micrometer": "um", "mikrometer": "um", "microns": "um", "micron": "um",
    "kp": "kgf", "pond": "gf", "gramm": "g", "gr": "g", "lbs": "lb",
}  # fmt: skip
BRIDGE = re.compile(r"[mµu]?V/V")  # the signal of strain gauges over their supply
PER_BRIDGE = re.compile(rf"(.*?)/\(?({BRIDGE.pattern})\)?")
PREFIXES = {  # of units that are written with them
    "s": ("n", "u", "m", ""),
    "N": ("n", "u", "m", "", "k", "M"),
    "gf": ("", "k"),
    "g": ("", "k"),
}
COUNTS = {"count", "lsb", "digit", "bit", "step"}
RATIOS = {"-", "1", "", "–", "--", "none", "n/a", "[-]", "ratio"}
IN = re.compile(r"in (?!lb|oz)", re.I)  # "in kN" is not an inch; "in lbf" is a moment
BRACKETS = re.compile(r"\s*[\[({<]\s*([^\[\](){}<>]*?)\s*[\])}>]\s*")
QUANTITY = re.compile(r"\s*([+−-]?\s*(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[+−-])\s*(.*)", re.S)
NAMED = re.compile(r"(.*?)\s*[\[({]\s*([^\[\](){}]*?)\s*[\])}]\s*(.*)", re.S)


class Size(NamedTuple):
    """The size of one unit of a column in SI, and a note on how the unit was read."""

    value: float
    note: str = ""


def size_of(text: str, unit: str, stated: str = "") -> Size | None:
    """Return the size of the unit `text` in the SI unit `unit`; None if it does not fit.

    A unit of mass stands for the weight of that mass. A number before the unit multiplies it:
    ``-1 N`` turns the sign, ``2.5 N/V`` is the size of one volt, of a column stated in volts.

    Examples
    --------
    >>> size_of("mN", "N"), size_of("g", "N").value, size_of("2.5 N/V", "N", "mV").value
    (Size(value=0.001, note=''), 0.00980665, 0.0025)
    >>> size_of("mN", "s") is None
    True
    """
    found = QUANTITY.fullmatch(text)
    number, name = (found[1], found[2]) if found else ("1", text)
    number = re.sub(r"\s", "", number).replace("−", "-")
    times = float(f"{number}1" if number in ("+", "-") else number)
    name = spell(name)
    if times == 0.0 or not abs(times) < 1e60:
        return None
    if "/" in name:
        per_bridge = PER_BRIDGE.fullmatch(name)
        parts = per_bridge.groups() if per_bridge else name.rsplit("/", 1)
        upper, lower = map(spell, parts)
        per = _raw_units(spell(stated) or lower, lower)
        if per and (one := size_of(upper, unit)) is not None:
            return Size(times * one.value * per, one.note)
    size = _factor(name, unit)
    if size is not None:
        mega = unit == "N" and name.startswith("M") and size >= MEGA
        return Size(times * size, f"{name} is read as {MEGANEWTONS}" if mega else "")
    mass = _factor(name, "kg") if unit == "N" else None
    if mass is not None:
        gram = "gram-force" if name == "g" else f"the weight of a mass in {name}"
        return Size(times * mass * GRAVITY, f"{name} is read as {gram}")
    return None


def with_other_sign(text: str) -> str:
    """Return the unit that reads the same column with the other sign.

    Examples
    --------
    >>> with_other_sign("mN"), with_other_sign("2.5 N/V"), with_other_sign("-1 gf")
    ('-1 mN', '-2.5 N/V', '1 gf')
    """
    found = QUANTITY.fullmatch(text)
    number, name = (found[1].replace("−", "-"), found[2]) if found else ("1", text)
    number = f"{number}1" if number in ("+", "-") else number
    return f"{number[1:]} {name}" if number[0] == "-" else f"-{number.lstrip('+')} {name}"


def with_prefix(text: str, unit: str, power: int) -> str:
    """Return the unit that is 1000**power as large, by its prefix; '' if nobody writes it so.

    Examples
    --------
    >>> with_prefix("mN", "N", 1), with_prefix("-0.5 N/V", "N", -1), with_prefix("gf", "N", 1)
    ('N', '-0.5 mN/V', 'kgf')
    >>> with_prefix("min", "s", -1), with_prefix("s", "s", 1), with_prefix("sec", "s", -1)
    ('', '', 'ms')
    """
    found = QUANTITY.fullmatch(text)
    number, name = (f"{found[1]} ", found[2]) if found else ("", text)
    upper, over, lower = name.partition("/")
    upper = spell(upper)
    had = size_of(upper, unit)
    for base, prefixes in PREFIXES.items():
        if had is None or not upper.endswith(base):
            continue
        for prefix in prefixes:
            its = size_of(prefix + base, unit)
            if its is not None and isclose(its.value, had.value * 1000.0**power):
                return f"{number}{prefix}{base}{over}{lower}"
    return ""


def in_thousands(text: str, power: int) -> str:
    """Return the unit that is 1000**power as large, by its number.

    >>> in_thousands("min", -1), in_thousands("-1 lbf", 1), in_thousands("1000 s", -1)
    ('0.001 min', '-1000 lbf', 's')
    """
    found = QUANTITY.fullmatch(text)
    number, name = (found[1].replace("−", "-"), found[2]) if found else ("1", text)
    value = float(f"{number}1" if number in ("+", "-") else number.replace(" ", ""))
    times = f"{value * 1000.0**power:.12g}"
    return name if times == "1" else f"{times} {name}"


def is_electric(text: str) -> bool:
    """Return whether a unit belongs to a raw signal: a voltage, a current, counts."""
    return _raw_units(spell(text), spell(text)) is not None


def is_ratio(text: str) -> bool:
    """Return whether a unit says that a column has none: ``-``, ``1``, ``%``."""
    return text.strip().lower() in RATIOS or text.strip() == "%"


def is_unit(text: str) -> bool:
    """Return whether a text is a unit, a ratio or a decibel-like scale that instruments write."""
    inner = BRACKETS.fullmatch(text)
    name = spell(inner[1] if inner else text)
    if is_ratio(name):
        return True
    try:
        factor(name, "s")
    except UnitError:
        return False
    return True


def spell(text: str) -> str:
    """Return a unit by the name that the registry knows."""
    text = text.strip().strip(".").replace("μ", "µ").replace("⋅", "*")
    inner = BRACKETS.fullmatch(text)
    text = IN.sub("", inner[1] if inner else text, count=1)
    return SPELLED.get(text.lower(), text)


def split_unit(heading: str) -> tuple[str, str]:
    """Return name and unit of a heading; the unit is '' if there is none.

    Examples
    --------
    >>> split_unit("Force [mN]"), split_unit("t/s"), split_unit("time_ms"), split_unit("F_N")
    (('Force', 'mN'), ('t', 's'), ('time', 'ms'), ('F_N', ''))
    >>> split_unit("Kraft N"), split_unit("F N"), split_unit("force.N"), split_unit("t_s")
    (('Kraft', 'N'), ('F N', ''), ('force', 'N'), ('t', 's'))
    """
    heading = heading.strip().strip('"').strip()
    found = NAMED.fullmatch(heading)
    if found and found[1] and is_unit(found[2]):
        name = f"{found[1]} {found[3]}".strip()
        return name, spell(found[2]) if found[2].strip() else ""
    for mark in ("/", "_", " in ", ";", ":", ","):
        name, at, unit = heading.rpartition(mark)
        name, unit = name.strip(), unit.strip()
        weight = mark == "/" and unit in ("mg", "W", "g")  # F/mg is a coefficient
        short = mark == "_" and len(name) == 1 and len(unit) == 1
        symbol = short and (name, unit) != ("t", "s")  # F_N is the normal force
        plain = bool(at and name and unit) and not weight and not symbol and not is_ratio(unit)
        if plain and (len(unit) <= 4 or unit.lower() in SPELLED) and is_unit(unit):
            return name, spell(unit)
    for mark in (" ", "."):
        name, _, unit = heading.rpartition(mark)
        if is_channel(name, unit) and not is_channel(heading):
            return name.strip(), spell(unit)
    return heading, SPELLED.get(heading.lower(), "")


def is_channel(name: str, unit: str = "") -> bool:
    """Return whether a column of this name, in this unit if one is given, is a channel's.

    >>> is_channel("Kraft", "N"), is_channel("Kraft", "s"), is_channel("F N")
    (True, False, True)
    """
    return any(
        each.names.fullmatch(plain(name)) and (not unit or size_of(unit, each.unit) is not None)
        for each in CHANNELS.values()
    )


def _raw_units(stated: str, unit: str) -> float | None:
    """Return how many of a unit of a raw signal one `stated` unit is; None if it is none."""
    if unit.lower().rstrip("s") in COUNTS:
        return 1.0 if stated.lower().rstrip("s") in COUNTS else None
    of_bridge = BRIDGE.fullmatch(stated) and BRIDGE.fullmatch(unit)
    if of_bridge or any(_factor(unit, one) is not None for one in ("V", "A")):
        return _factor(stated, unit)
    return None


def _factor(text: str, unit: str) -> float | None:
    try:
        return factor(text, unit)
    except UnitError:
        return None
