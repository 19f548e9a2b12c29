"""From a number in SI to the text of a quantity, which reads back to the last digit."""

from __future__ import annotations

from decimal import Decimal
from math import isinf, pi, radians

from stiction.text.quantity.prefix import SI

RIGID = "rigid"  # of an infinite stiffness
LONG = 8  # characters of a number that no prefix makes short
PREFIXES = {3 * power: "u" if letter == "µ" else letter for power, letter in SI.items()}
# unit: the name that takes the prefix, and the powers of ten that are used
SMALL, BOTH = (0, -3, -6, -9), (9, 6, 3, 0, -3, -6, -9)
PREFIXED = {
    "kg": ("g", (3, 0, -3, -6, -9, -12)),  # of a gram
    "m": ("m", SMALL),
    "s": ("s", SMALL),
    "m/s": ("m/s", SMALL),
    "N": ("N", BOTH),
    "N/m": ("N/m", BOTH),
    "m/N": ("m/N", SMALL),
    "N*s/m": ("N s/m", (6, 3, 0, -3)),
    "Hz": ("Hz", (9, 6, 3, 0)),
}


def quantity_text(value: float, unit: str) -> str:
    """Return a value in an SI unit as the shortest exact text, for a description.

    Examples
    --------
    >>> quantity_text(0.001, "m/s"), quantity_text(1e7, "N/m"), quantity_text(0.0123, "kg")
    ('1 mm/s', '10 MN/m', '12.3 g')
    """
    if unit == "rad":
        return angle_text(value)
    if unit == "N/m" and isinf(value):
        return RIGID
    if unit not in PREFIXED:
        return f"{value!r} {unit}".rstrip()
    if value == 0.0:
        return f"0 {unit}".replace("*", " ")
    name, powers = PREFIXED[unit]
    exact = Decimal(repr(float(value))).scaleb(3 if unit == "kg" else 0)
    texts = [f"{_plain(exact.scaleb(-power))} {PREFIXES[power]}{name}" for power in powers]
    # among the shortest, and among long ones, prefer a number from 1 to 1000
    return min(
        texts,
        key=lambda text: (min(len(text.split()[0]), LONG), not 1 <= abs(_number(text)) < 1000),
    )


def angle_text(value: float) -> str:
    """Return an angle in degrees if these are exact, else in radians.

    Examples
    --------
    >>> angle_text(radians(1.0)), angle_text(0.1)
    ('1 deg', '0.1 rad')
    """
    value = float(value)
    degrees = value * 180.0 / pi
    for text in (f"{degrees:.6g}", f"{degrees:.15g}", repr(degrees)):
        if float(text) * radians(1.0) == value and len(text) <= len(repr(value)):
            return f"{text} deg"
    return f"{value!r} rad"


def _plain(value: Decimal) -> str:
    """Return a decimal number without trailing zeros, and without an exponent if that is short."""
    digits = value.normalize()
    plain = f"{digits:f}"
    return plain if len(plain) <= LONG else f"{digits:g}"


def _number(text: str) -> float:
    return float(text.split()[0])
