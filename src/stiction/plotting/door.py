"""One function that draws any object with a figure."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from stiction.comparison import Comparison
from stiction.errors import StictionError
from stiction.text.units import Quantity
from stiction.trajectory import Trajectory, load


def plot(
    source: Any, axes: Any = None, *, window: Sequence[Quantity] | None = None, trust: bool = False
) -> Any:
    """Draw a run, an analysis, a comparison, an audit, a map or anything else with a figure.

    Parameters
    ----------
    source : object, str or Path
        The object to draw, with a method ``plot``, or the file of a run.
    axes : Axes, mapping or sequence of Axes, optional
        Drawn on, as the figure of the object takes them; by default a new figure, which pyplot
        shows.
    window : tuple of float or str, optional
        Of a run or a comparison, start and end in time, s; all of it by default.
    trust : bool, optional
        For a file; see `stiction.load`.

    Returns
    -------
    Axes, dict of str to Axes, or ndarray of Axes
        The axes of the drawing: those of a run or a comparison by name, an array where there is a
        panel or several, and else one. The figure of the object says which, `plot_run` for example.

    Raises
    ------
    StictionError
        If there is nothing to draw, or it has no such window.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "0.1 s", sample_rate="10 kHz")
    >>> axes = st.plot(run)
    """
    found = load(source, trust=trust) if isinstance(source, str | Path) else source
    if not hasattr(found, "plot"):
        found = getattr(found, "slider", found)  # of a description, or a rig
    if not hasattr(found, "plot"):
        remedy = "give a run, an analysis or a slider"
        raise StictionError(f"{type(found).__name__} has no figure; {remedy}")
    if window is None:
        return found.plot(axes)
    if not isinstance(found, Trajectory | Comparison):
        raise StictionError(f"window: {type(found).__name__} has none; a run or a comparison has")
    return found.plot(axes, window=window)
