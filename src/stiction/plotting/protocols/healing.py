"""Healing: the gain of peak friction over the hold time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from stiction.plotting.page.canvas import panel
from stiction.plotting.page.style import BLACK, BLUE, COLUMN, style

if TYPE_CHECKING:
    from stiction.analysis.protocols.healing import Healing


def plot_healing(found: Healing, ax: Axes | None = None) -> Axes:
    """Draw peak less steady friction over the hold time, and the line through it.

    Parameters
    ----------
    found : Healing
        From `stiction.analysis.healing`.
    ax : Axes, optional
        Drawn on; a new figure as wide as a column when left out.
    """
    with style():
        ax = panel(ax, COLUMN, 2.4)
        ax.plot(found.hold, found.gain, "o", color=BLACK, markersize=3.0, label="each hold")
        if np.isfinite(found.per_decade):
            holds = np.array([found.hold.min(), found.hold.max()])
            line = found.at_one_second + found.per_decade * np.log10(holds)
            label = f"{found.per_decade:.3g} per decade"
            if found.per_decade_error > 0.0:
                label += rf" $\pm$ {found.per_decade_error:.1g}"
            ax.plot(holds, line, color=BLUE, label=label)
        ax.set_xscale("log")
        ax.set_xlabel("hold time (s)")
        ax.set_ylabel(r"$\Delta\mu$: peak less steady (1)")
        ax.legend(loc="upper left")
    return ax
