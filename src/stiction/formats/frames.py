"""Tables in memory: data frames of pandas and datasets of xarray.

Units stand in the names, in ``attrs["units"]`` of a variable, or, by name, in that of a data frame.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Protocol, runtime_checkable

import numpy as np

from stiction.errors import ResultError
from stiction.formats.members import Member, tables_of
from stiction.formats.table import FileTable

FRAMES = "DataFrame", "Dataset"
DATES = "Mm"  # kinds of NumPy's types for dates and durations


@runtime_checkable
class DataFrame(Protocol):
    """A data frame, as pandas has it, which takes a while to load."""

    @property
    def columns(self) -> Any:
        """The names of its columns."""

    @property
    def index(self) -> Any:
        """The values by which its rows are known."""

    @property
    def attrs(self) -> Any:
        """Further statements about it, by name."""


def is_frame(source: object) -> bool:
    """Return whether something is a data frame or a dataset, whose package need not be loaded."""
    return any(kind.__name__ in FRAMES for kind in type(source).__mro__)


def tables_of_frame(frame: Any) -> list[FileTable]:
    """Return the tables of a data frame or a dataset.

    Raises
    ------
    ResultError
        If it holds no samples.

    Examples
    --------
    >>> import pandas as pd
    >>> frame = pd.DataFrame({"Fx [mN]": [1.0, 2.0]}, index=pd.Index([0.0, 0.5], name="t [s]"))
    >>> [column.heading for column in tables_of_frame(frame)[0].columns]
    ['t [s]', 'Fx [mN]']
    """
    name = type(frame).__name__
    members = _variables(frame) if hasattr(frame, "variables") else _columns(frame)
    tables = [table for table in tables_of(members, f"{name} in memory") if len(table)]
    if not tables:
        raise ResultError(f"{name}: no samples in it, or none that are numbers")
    return tables


def _variables(dataset: Any) -> Iterator[Member]:
    """Yield the variables of a dataset, those along which others lie first."""
    names = [*dataset.indexes, *(each for each in dataset.variables if each not in dataset.indexes)]
    for name in names:
        its = dataset.variables[name]
        yield Member("", str(name), np.asarray(its.values), str(its.attrs.get("units", "")))


def _columns(frame: Any) -> Iterator[Member]:
    """Yield the index of a data frame, if it is more than a count, and its columns of numbers."""
    units = frame.attrs.get("units")
    units = units if isinstance(units, Mapping) else {}
    index = frame.index
    if index.name is not None or type(index).__name__ != "RangeIndex":
        yield _member("time" if index.name is None else index.name, index.to_series(), units)
    for number, name in enumerate(frame.columns):
        yield _member(name, frame.iloc[:, number], units)


def _member(name: Any, series: Any, units: Mapping[Any, Any]) -> Member:
    """Return a column of a data frame; of dates with a time zone, in universal time."""
    kind, text = series.dtype, " ".join(map(str, name)) if isinstance(name, tuple) else str(name)
    unit = str(units.get(name, series.attrs.get("units", "")))
    if getattr(kind, "tz", None) is not None:
        values = series.dt.tz_convert(None).to_numpy()
    elif getattr(kind, "kind", "O") in DATES:
        values = series.to_numpy()
    else:
        try:
            values = series.to_numpy(dtype=np.float64, na_value=np.nan)
        except (TypeError, ValueError):  # words
            values = series.to_numpy(dtype=object)
    return Member("", text, values, unit)
