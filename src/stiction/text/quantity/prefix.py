"""The metric prefix that suits a value."""

from __future__ import annotations

from math import floor, log10, pi

import numpy as np
from numpy.typing import ArrayLike

SI = dict(zip(range(-10, 11), [*"qryzafpnµm", "", *"kMGTPEZYRQ"], strict=True))  # of thousands
BARE = ("", "1", "%", "1/s", "1/s²", "deg")  # units that take no prefix
DIGITS = 4  # of a number in a sentence
YEAR = 31557600.0  # s: 365.25 days, as "yr" is read


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


def metric_prefix(values: ArrayLike) -> tuple[float, str]:
    """Return factor and prefix (n, µ, m, none, k) that bring values to 0.2 to 200."""
    largest = np.fmax.reduce(np.abs(np.asarray(values, dtype=np.float64)), initial=0.0)
    if not 0 < largest < np.inf:
        return 1.0, ""
    power = min(max(thousands(5.0 * largest, "m"), -8), 2)
    return 1000.0**-power, SI[power]
