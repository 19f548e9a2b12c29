"""Columns of numbers, each with one unit and one number of decimals, for easy comparison."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import floor, isfinite, log10
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from stiction.text.quantity.prefix import DIGITS, SI, thousands
from stiction.text.quantity.wording import MEASURABLE
from stiction.text.sections import Table

SHOWN_ROWS = 8  # rows in the terminal; tables that are exported hold all
PICO = -4  # the power of a thousand


class Quantity(NamedTuple):
    """Values of a quantity, (n,), and their SI unit."""

    values: ArrayLike
    unit: str


def grid(quantities: Mapping[str, Quantity], rows: int, alike: str = "") -> Table:
    """Return a table of the first `rows` of some quantities, each in a suitable unit.

    Columns in the unit `alike` share one prefix, so that they can be compared and added.

    Examples
    --------
    >>> grid({"force": Quantity([0.25, -0.0012, float("nan")], "N")}, 3)
    Table(headings=('force (mN)',), rows=[('250.0',), ('-1.2',), ('none',)])
    """
    columns, headings = [], []
    together = [np.ravel(values)[:rows] for values, unit in quantities.values() if unit == alike]
    common = scale(np.concatenate(together).tolist(), alike) if together else (0, 0)
    for name, (values, unit) in quantities.items():
        numbers = np.asarray(values, dtype=np.float64)[:rows]
        power, decimals = common if unit == alike else scale(numbers.tolist(), unit)
        headings.append(name if unit == "1" else f"{name} ({SI[power]}{unit})")
        columns.append([cell(value / 1000.0**power, decimals) for value in numbers.tolist()])
    return Table(tuple(headings), list(zip(*columns, strict=True)))


def scale(values: Sequence[float], unit: str) -> tuple[int, int]:
    """Return a power of a thousand, and decimals, for four digits of the largest value.

    Lengths that no instrument can measure are zero picometres.
    """
    largest = max((abs(value) for value in values if isfinite(value)), default=0.0)
    # of the rounded value, so that 999.97 is 1.000 of the next prefix
    size = floor(log10(float(f"{largest:.{DIGITS - 1}e}"))) if largest > 0.0 else 0
    if unit == "m" and largest < MEASURABLE:
        return PICO, 0
    power = thousands(largest, unit)
    return power, max(0, DIGITS - 1 - (size - 3 * power))


def cell(value: float, decimals: int) -> str:
    """Return a number with fixed decimals, zero without a sign, or 'none' if not finite."""
    return f"{round(value, decimals) + 0.0:.{decimals}f}" if isfinite(value) else "none"


def rows_left_out(count: int, things: str, file: str) -> list[str]:
    """Return a sentence on the rows that a table lacks, if there are more than it shows.

    Examples
    --------
    >>> rows_left_out(8, "cycles", "cycles.csv")
    []
    >>> print(*rows_left_out(53, "cycles", "cycles.csv"))
    These are the first 8 of 53 cycles; export(...) writes all, stiction analyse to cycles.csv.
    """
    if count <= SHOWN_ROWS:
        return []
    some = f"These are the first {SHOWN_ROWS} of {count} {things}"
    return [f"{some}; export(...) writes all, stiction analyse to {file}."]
