"""Summary of a table of cycles: mean and spread of each quantity."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

TIMES = ("start", "peak_time", "trough_time")  # instants, whose mean is meaningless


def summary(cycles: xr.Dataset) -> xr.Dataset:
    """Return mean and spread of each quantity of a table of cycles.

    Parameters
    ----------
    cycles : Dataset
        From ``st.analysis.find_cycles``.

    Returns
    -------
    Dataset
        Over ``quantity`` (names, with ``unit`` beside them): ``mean``, ``standard_deviation`` of
        a single cycle (divide by the square root of `number` for that of the mean), and
        ``number`` of cycles in which the quantity is known. NaN if there are fewer than one, or
        two, of them.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> time = np.arange(0.0, 10.0, 1e-3)
    >>> cycles = st.analysis.find_cycles(st.Record(time=time, force=0.1 * (time % 2.0)))
    >>> float(st.analysis.summary(cycles)["mean"].sel(quantity="period").round(6))
    2.0
    """
    import xarray as xr

    names = [str(name) for name in cycles.data_vars if name not in TIMES]
    values = [cycles[name].values[np.isfinite(cycles[name].values)] for name in names]
    columns = {
        "mean": [v.mean() if len(v) else np.nan for v in values],
        "standard_deviation": [v.std(ddof=1) if len(v) > 1 else np.nan for v in values],
        "number": [len(v) for v in values],
    }
    meanings = {
        "mean": "mean over cycles",
        "standard_deviation": "standard deviation over cycles",
        "number": "cycles in which it is known",
    }
    return xr.Dataset(
        {
            key: ("quantity", column, {"long_name": meanings[key]})
            for key, column in columns.items()
        },
        {
            "quantity": names,
            "unit": ("quantity", [cycles[name].attrs["units"] for name in names]),
            "meaning": ("quantity", [cycles[name].attrs["long_name"] for name in names]),
        },
    )
