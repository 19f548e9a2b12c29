"""One function that draws any object with a figure."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from stiction.errors import StictionError
from stiction.trajectory import load


def plot(source: Any, axes: Any = None, *, trust: bool = False) -> Any:
    """Draw a run, an analysis, a comparison, an audit, a map or anything else with a figure.

    Parameters
    ----------
    source : object, str or Path
        The object to draw, with a method ``plot``, or the file of a run.
    axes : Axes or sequence of Axes, optional
        Drawn on; by default a new figure, which pyplot shows.
    trust : bool, optional
        For a file; see `stiction.load`.

    Returns
    -------
    Axes or sequence of Axes
        The axes of the drawing.

    Raises
    ------
    StictionError
        If there is nothing to draw.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "0.1 s", sample_rate="10 kHz")
    >>> axes = st.plot(run)
    """
    found = load(source, trust=trust) if isinstance(source, str | Path) else source
    if not hasattr(found, "plot"):
        raise StictionError(f"{type(found).__name__} has no figure; give a run or an analysis")
    return found.plot(axes)
