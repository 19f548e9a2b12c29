"""The examination of steady sliding, over one parameter or two."""

from __future__ import annotations

from typing import Any

from stiction.linear_stability import Stability
from stiction.plotting.stability.boundary import plot_boundary
from stiction.plotting.stability.modes import plot_modes


def plot_stability(found: Stability, axes: Any = None) -> Any:
    """Draw the modes over one parameter, or the boundary in the plane of two.

    Parameters
    ----------
    found : Stability
        From `stiction.stability`.
    axes : Axes, optional
        As of `plot_modes` (two of them) or `plot_boundary` (one).

    Examples
    --------
    >>> import stiction as st
    >>> axes = st.plotting.plot_stability(st.stability(st.presets.nakano_popov_2020(), over="phi"))
    """
    if len(found.criticals) == 2:
        return plot_boundary(found.boundary, ax=axes)
    return plot_modes(found.modes, found.criticals[0], axes)
