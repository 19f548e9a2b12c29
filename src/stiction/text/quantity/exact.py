"""From a number in SI to the text of a quantity, which reads back to the last digit."""

from __future__ import annotations

from decimal import Decimal
from math import isinf, pi, radians

from stiction.text.quantity.prefix import SI

RIGID = "rigid"  # of an infinite stiffness
LONG = 8  # characters of a number that no prefix makes short
PREFIXES = {3 * power: "u" if letter == "µ" else letter for power, letter in SI.items()}


def _with_prefixes(name: str, most: int, least: int, own: int = 0) -> dict[str, int]:
    """Return a unit, itself a power of ten, with prefixes, and the power of each."""
    return {f"{PREFIXES[power]}{name}": power + own for power in range(most, least - 1, -3)}


# of each unit in SI, those in which its values are written, with their powers of ten in it
PREFIXED = {
    "kg": _with_prefixes("t", 6, 0, own=3) | _with_prefixes("g", 3, -12, own=-3),
    "m": _with_prefixes("m", 0, -9),
    "s": _with_prefixes("s", 0, -9),
    "m/s": _with_prefixes("m/s", 0, -9),
    "N": _with_prefixes("N", 9, -9),
    "N/m": _with_prefixes("N/m", 9, -9),
    "m/N": _with_prefixes("m/N", 0, -9),
    "N*s/m": _with_prefixes("N s/m", 6, -9),
    "Hz": _with_prefixes("Hz", 9, -3),
}


def quantity_text(value: float, unit: str) -> str:
    """Return a value in an SI unit as the shortest exact text, for a description.

    Examples
    --------
    >>> quantity_text(0.001, "m/s"), quantity_text(1e7, "N/m"), quantity_text(0.0123, "kg")
    ('1 mm/s', '10 MN/m', '12.3 g')
    >>> quantity_text(6e7, "kg"), quantity_text(1e-5, "N*s/m"), quantity_text(0.02, "Hz")
    ('60 kt', '10 uN s/m', '20 mHz')
    """
    if unit == "rad":
        return angle_text(value)
    if unit == "N/m" and isinf(value):
        return RIGID
    if unit not in PREFIXED:
        return f"{value!r} {unit}".rstrip()
    if value == 0.0:
        return f"0 {unit}".replace("*", " ")
    exact = Decimal(repr(float(value)))
    return min(
        (f"{_plain(exact.scaleb(-power))} {name}" for name, power in PREFIXED[unit].items()),
        key=_reluctance,
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


def _reluctance(text: str) -> tuple[bool, int, int]:
    """Return the key of texts of a quantity: one without a power of ten, short, near 1 to 1000."""
    number = text.split()[0]
    beyond = max(abs(Decimal(number).adjusted() - 1), 1)
    return "e" in number.lower(), min(len(number), LONG), beyond
