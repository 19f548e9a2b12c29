"""Columns of measured numbers: arrays that may carry a unit, in SI inside."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

import numpy as np

from stiction.arrays import Floats
from stiction.storage.checksums import bytes_of, crc
from stiction.text.quantity.calendar import of_clock, seconds
from stiction.text.units import Kind, to_si

_whole: ContextVar[bool] = ContextVar("_whole", default=False)


@contextmanager
def with_all_values() -> Iterator[None]:
    """Print columns with all of their values inside the ``with`` block.

    Examples
    --------
    >>> with with_all_values():
    ...     print(FrozenColumn([0.0, 0.5]))
    [0.0, 0.5]
    """
    before = _whole.set(True)
    try:
        yield
    finally:
        _whole.reset(before)


def as_numbers(values: Any) -> Floats:
    """Return a new array of floats with one dimension; masked values are NaN.

    Raises
    ------
    ValueError
        If the values are not numbers in a row.
    """
    try:
        given = np.ma.asanyarray(values) if np.ma.isMaskedArray(values) else np.asarray(values)
    except ValueError:  # ragged or nested lists
        raise ValueError("must be numbers, one a sample, in SI") from None
    if given.dtype.kind in "cmMSU":  # complex numbers, times of a calendar, text
        raise ValueError(f"must be numbers, one a sample, in SI, not of type {given.dtype}")
    try:
        numbers = np.array(np.ma.filled(given.astype(np.float64), np.nan))
    except (TypeError, ValueError, OverflowError):
        raise ValueError("must be numbers, one a sample, in SI") from None
    if numbers.ndim != 1:
        raise ValueError(f"must have one dimension, has {numbers.ndim}; give one number per sample")
    return numbers


def samples_to_si(values: Any, unit: str, kind: Kind) -> Any:
    """Convert samples from a unit to SI; dates, to seconds since the first."""
    plain = getattr(values, "magnitude", values)
    plain = seconds(plain) if of_clock(plain) else getattr(plain, "values", plain)
    factor = to_si(f"1 {unit}", kind)
    if factor == 1.0 or np.asarray(plain).dtype.kind not in "iuf":
        return plain
    return plain * factor if isinstance(plain, np.ndarray) else np.asarray(plain) * factor


class FrozenColumn:
    """Numbers that never change, which compare, hash and print as one value.

    Parameters
    ----------
    values : array_like
        (n,), floats; they are copied.

    Examples
    --------
    >>> column = FrozenColumn([0.0, 0.5])
    >>> column == FrozenColumn([0.0, 0.5]), column
    (True, <2 values>)
    """

    __slots__ = ("_mark", "values")

    def __init__(self, values: Any) -> None:
        """Copy the values."""
        self.values: Floats = np.array(values, dtype=np.float64)
        self.values.setflags(write=False)
        self._mark: int | None = None

    @property
    def mark(self) -> int:
        """The checksum of the values."""
        if self._mark is None:
            self._mark = crc(bytes_of(self.values))
        return self._mark

    @property
    def size(self) -> int:
        """Number of values."""
        return self.values.size

    def tolist(self) -> list[float]:
        """Return the values as a list."""
        found: list[float] = self.values.tolist()
        return found

    def __len__(self) -> int:
        """Return the number of values."""
        return self.values.size

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Floats:
        """Return a copy of the values for NumPy, which may be changed."""
        return np.array(self.values, dtype=dtype)

    def __eq__(self, other: object) -> bool:
        """Return whether another column has the same values."""
        if self is other:
            return True
        return isinstance(other, FrozenColumn) and np.array_equal(self.values, other.values)

    def __hash__(self) -> int:
        """Return the checksum."""
        return hash(self.mark)

    def __repr__(self) -> str:
        """Return how many values there are, or all (see `with_all_values`)."""
        return repr(self.tolist()) if _whole.get() else f"<{self.size} values>"

    def __reduce__(self) -> tuple[type[FrozenColumn], tuple[Floats]]:
        """Copy and pickle the values."""
        return FrozenColumn, (self.values,)
