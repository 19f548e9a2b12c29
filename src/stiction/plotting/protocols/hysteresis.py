"""Hysteresis: the loops of force over travel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from stiction.plotting.page.canvas import panel
from stiction.plotting.page.style import BLACK, BLUE, COLUMN, GREY, style
from stiction.text.units import in_words

if TYPE_CHECKING:
    from stiction.analysis.protocols.hysteresis import Hysteresis


def plot_hysteresis(found: Hysteresis, ax: Axes | None = None) -> Axes:
    """Draw the loops of a reversal test, the last one shaded.

    Parameters
    ----------
    found : Hysteresis
        From `stiction.analysis.hysteresis`.
    ax : Axes, optional
        Drawn on; a new figure as wide as a column when left out.
    """
    with style():
        ax = panel(ax, COLUMN, 2.6)
        last = found.loops[-1]
        for each in found.loops[:-1]:
            ax.plot(1e3 * each.travel, each.force, color=GREY, linewidth=0.6)
        label = f"loop {len(found.loops)}: {in_words(last.area, 'J', 3)}"
        ax.fill(1e3 * last.travel, last.force, color=BLUE, alpha=0.12, linewidth=0)
        ax.plot(1e3 * last.travel, last.force, color=BLUE, label=label)
        middle = 0.5 * (float(np.max(last.force)) + float(np.min(last.force)))
        ax.axhline(middle, color=BLACK, linewidth=0.4)
        ax.set_xlabel("travel of the drive since its turn (mm)")
        ax.set_ylabel("force along the drive (N)")
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return ax
