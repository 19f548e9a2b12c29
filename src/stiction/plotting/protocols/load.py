"""Load dependence: friction over normal load."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from stiction.plotting.page.canvas import panel
from stiction.plotting.page.style import BLACK, BLUE, COLUMN, style

if TYPE_CHECKING:
    from stiction.analysis.protocols.load_dependence import LoadDependence


def plot_load_dependence(found: LoadDependence, ax: Axes | None = None) -> Axes:
    """Draw friction over the normal load, and the line through it down to zero load.

    Parameters
    ----------
    found : LoadDependence
        From `stiction.analysis.load_dependence`.
    ax : Axes, optional
        Drawn on; a new figure as wide as a column when left out.
    """
    with style():
        ax = panel(ax, COLUMN, 2.4)
        ax.plot(found.load, found.force, "o", color=BLACK, markersize=3.0, label="each level")
        loads = np.array([0.0, found.load.max()])
        label = f"slope {found.coefficient:.4g}"
        ax.plot(loads, found.adhesion + found.coefficient * loads, color=BLUE, label=label)
        ax.set_xlabel("normal load (N)")
        ax.set_ylabel("friction (N)")
        ax.legend(loc="upper left")
    return ax
