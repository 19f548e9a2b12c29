"""From a number in SI to the text of a quantity, which reads back to the last digit."""

from __future__ import annotations

from decimal import Decimal
from math import floor, isinf, log10, pi, radians

import numpy as np
from numpy.typing import ArrayLike

SI = dict(zip(range(-10, 11), [*"qryzafpnµm", "", *"kMGTPEZYRQ"], strict=True))  # of thousands
RIGID = "rigid"  # of an infinite stiffness
BARE = ("", "1", "%", "1/s", "1/s²", "deg")  # units that take no prefix
DIGITS = 4  # of a number in a sentence
LONG = 8  # characters of a number that no prefix makes short
ALL = 1e-6  # a share that is less is none, and one that lacks less is the whole
SLIGHT = 1e-3  # of a value: an error that is less is not worth a word
MEASURABLE = 1e-12  # m, a hundredth of an atom: no instrument follows a mass so closely
YEAR = 31557600.0  # s: 365.25 days, as "yr" is read
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


def thousands(value: float, unit: str, digits: int = DIGITS) -> int:
    """Return the power of a thousand that leaves 1 to 1000; 0 for a unit without prefix.

    The value is rounded first, so that 999.97 is 1 of the next prefix.

    Examples
    --------
    >>> thousands(0.0123, "m"), SI[thousands(999.97, "N")], thousands(1e-3, "1/s")
    (-1, 'k', 0)
    """
    if value == 0.0 or unit in BARE:
        return 0
    most = 0 if unit == "s" else 10  # nobody writes kiloseconds
    return min(max(floor(log10(float(f"{abs(value):.{digits - 1}e}"))) // 3, -10), most)


def suited_unit(value: float, unit: str, digits: int = DIGITS) -> tuple[float, str]:
    """Return the size of the unit that suits a value, in the SI unit, and its name.

    Examples
    --------
    >>> suited_unit(0.0123, "kg"), suited_unit(8e3, "kg"), suited_unit(0.5, "1")
    ((0.001, 'g'), (1000.0, 't'), (1.0, ''))
    >>> suited_unit(1e6, "s"), suited_unit(1e9, "s")
    ((1.0, 's'), (31557600.0, 'yr'))
    """
    if unit == "rad":
        return pi / 180.0, "deg"
    if unit == "s" and abs(value) >= YEAR:
        return YEAR, "yr"
    power = thousands(1e3 * value if unit == "kg" else value, unit, digits)
    if unit == "kg" and value != 0.0:
        name = f"{SI[power]}g" if power < 2 else f"{SI[power - 2]}t"
        return 1000.0 ** (power - 1), name
    return 1000.0**power, SI[power] + ("" if unit == "1" else unit.replace("*", " "))


def percent(share: float, digits: int = 2) -> str:
    """Return a share in per cent as text; one below the whole is not rounded up to it.

    Examples
    --------
    >>> percent(0.974), percent(0.9953), percent(0.0036), percent(1.0), percent(1.25)
    ('97 %', '99.5 %', '0.36 %', '100 %', '125 %')
    """
    shown, rest = 100.0 * share, 100.0 * (1.0 - share)
    if abs(share) < ALL:
        return "0 %"
    if 100.0 * ALL < rest < 0.5 * 10.0 ** (2 - digits):
        decimals = -floor(log10(rest))  # down to the first digit of the rest
        return f"{floor(shown * 10.0**decimals) / 10.0**decimals:.{decimals}f} %"
    digits = max(digits, len(f"{abs(shown):.0f}"))
    return f"{float(f'{shown:.{digits}g}'):g} %"


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


def metric_prefix(values: ArrayLike) -> tuple[float, str]:
    """Return factor and prefix (n, µ, m, none, k) that bring values to 0.2 to 200."""
    largest = np.fmax.reduce(np.abs(np.asarray(values, dtype=np.float64)), initial=0.0)
    if not 0 < largest < np.inf:
        return 1.0, ""
    power = min(max(thousands(5.0 * largest, "m"), -8), 2)
    return 1000.0**-power, SI[power]
