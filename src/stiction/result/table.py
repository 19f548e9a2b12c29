"""A table of columns with units: what a run holds before anybody asks for xarray.

xarray, and pandas below it, take as long to import as a run takes to simulate and write. A command
that only computes and writes does without them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from stiction.arrays import xr


class Column(NamedTuple):
    """An array with the names of its dimensions, its unit and its meaning."""

    dims: tuple[str, ...]
    values: np.ndarray
    attributes: Mapping[str, Any]


@dataclass(frozen=True, eq=False)
class ColumnTable:
    """Columns by name, and attributes of the whole.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "20 ms", sample_rate="1 kHz")
    >>> run.samples["time"][-1], run.samples.columns["u_x"].attributes["units"]
    (np.float64(0.02), 'm')
    """

    columns: Mapping[str, Column]
    attributes: Mapping[str, Any]

    def __getitem__(self, name: str) -> np.ndarray:
        """Return the values of a column."""
        return self.columns[name].values


def as_dataset(table: ColumnTable) -> xr.Dataset:
    """Return a table for xarray; a column that is named as its dimension is a coordinate."""
    return xr.Dataset(dict(table.columns), attrs=dict(table.attributes))


def as_table(data: xr.Dataset) -> ColumnTable:
    """Return what a dataset holds; the arrays are shared."""
    columns = {
        str(name): Column(tuple(map(str, each.dims)), each.values, each.attrs)
        for name, each in data.variables.items()
    }
    return ColumnTable(columns, data.attrs)
