"""Dates and spans of time, of Python, NumPy and pandas: numbers and rows of numbers in seconds."""

from __future__ import annotations

from datetime import date, timedelta
from typing import Any

OF_NUMPY = {"m", "M"}  # spans, and dates


def of_clock(values: Any) -> bool:
    """Return whether a value, or the first of a row of values, is a date or a span of time.

    >>> of_clock(timedelta(seconds=5)), of_clock([date(2024, 5, 1)]), of_clock([1.0])
    (True, True, False)
    """
    kind = _kind(values)
    row = isinstance(values, (list, tuple)) or (kind == "O" and values.ndim > 0)
    first = next(iter(values), None) if row else values
    return bool({kind, _kind(first)} & OF_NUMPY) or isinstance(first, (date, timedelta))


def _kind(values: object) -> object:
    return getattr(getattr(values, "dtype", None), "kind", None)


def span_in_seconds(value: Any) -> float | None:
    """Return one span of time in s; None for a date, and for months, which differ in length.

    >>> span_in_seconds(timedelta(minutes=2)), span_in_seconds(date(2024, 5, 1))
    (120.0, None)
    """
    if isinstance(value, timedelta):  # that of pandas, too
        return value.total_seconds()
    number = value[()] if getattr(value, "shape", None) == () else None
    if number is None or _kind(number) != "m":
        return None
    try:
        return float(number / type(number)(1, "s"))
    except TypeError:  # months
        return None


def seconds(values: Any) -> Any:
    """Return a row of dates as seconds since the first, and one of spans of time in seconds.

    >>> from datetime import datetime
    >>> seconds([datetime(2024, 5, 1, 12, 0, 0), datetime(2024, 5, 1, 12, 0, 2)])
    array([0., 2.])

    Raises
    ------
    ValueError
        If they are not a row, not all dates or all spans, or months, which differ in length.
    """
    import numpy as np

    unit = getattr(getattr(values, "dtype", None), "unit", None)  # of pandas, with a time zone
    row = np.asarray(values) if unit is None else np.asarray(values, f"M8[{unit}]")
    if row.ndim != 1:
        raise ValueError(f"must have one dimension, has {row.ndim}; give one time per sample")
    try:
        if row.dtype != object:
            return (row - row[:1] if row.dtype.kind == "M" else row) / np.timedelta64(1, "s")
        since = [each - row[0] for each in row] if isinstance(row[0], date) else row
        return np.array([each.total_seconds() for each in since])
    except (AttributeError, TypeError):
        raise ValueError("must be all dates or all spans of time, and not in months") from None
