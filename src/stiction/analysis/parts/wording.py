"""Numbers of an analysis as text, and for JSON."""

from __future__ import annotations

import re
from math import isfinite
from typing import Any

from stiction.arrays import xr
from stiction.text.quantity_text import percent
from stiction.text.units import in_digits, to_error

SHOWN = 8  # cycles in the terminal; tables that are exported hold all
SLIGHT = 1e-3  # of a value: an error that is less is not worth a word
ALIKE = 1e-5  # of a value: a spread that is less is the solver's, not the motion's


def with_spread(spread: float, mean: float, unit: str) -> str:
    """Return a spread in words, or an upper limit if it is below the accuracy of a run."""
    if not isfinite(spread):
        return ""
    if spread <= ALIKE * abs(mean):
        return f"< {percent(ALIKE)}"
    return in_digits(spread, unit, 2)


def mean_in_words(summary: xr.Dataset, quantity: str) -> str:
    """Return the mean of a quantity over cycles, in the digits that it has by their spread."""
    row = summary.sel(quantity=quantity)
    error = float(row["standard_deviation"]) / max(float(row["number"]), 1.0) ** 0.5
    return to_error(float(row["mean"]), error, str(row["unit"].values))


def first_sentence(text: str) -> str:
    """Return the first sentence of a text.

    >>> first_sentence("The force falls by 1.5 N. Analyse each part.")
    'The force falls by 1.5 N.'
    """
    return re.split(r"(?<=\.) ", text, maxsplit=1)[0]


def first_clause(text: str) -> str:
    """Return the first clause of a sentence, without its remedy or reason.

    >>> first_clause("The force drifts by 1.5 N/s: analyse its parts.")
    'The force drifts by 1.5 N/s'
    """
    return re.split(r"[.:;](?: |$)", text, maxsplit=1)[0]


def rows_left_out(count: int, things: str, file: str) -> list[str]:
    """Return a sentence on the rows that a table lacks, if there are more than it shows.

    Examples
    --------
    >>> rows_left_out(8, "cycles", "cycles.csv")
    []
    >>> print(*rows_left_out(53, "cycles", "cycles.csv"))
    These are the first 8 of 53 cycles; export(...) writes all, stiction analyse to cycles.csv.
    """
    if count <= SHOWN:
        return []
    some = f"These are the first {SHOWN} of {count} {things}"
    return [f"{some}; export(...) writes all, stiction analyse to {file}."]


def number(value: Any) -> float | None:
    """Return a number for JSON, None for NaN and infinity."""
    return float(value) if isfinite(float(value)) else None
