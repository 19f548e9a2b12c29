"""Apparent friction over the yaw angle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from stiction.plotting.page.canvas import panel
from stiction.plotting.page.style import BLACK, BLUE, COLUMN, RED, style

if TYPE_CHECKING:
    from stiction.analysis.protocols.yaw import ApparentFriction


def plot_apparent_friction(found: ApparentFriction, ax: Axes | None = None) -> Axes:
    """Draw what a load cell reads over the misalignment: its peak, its mean and its span.

    Parameters
    ----------
    found : ApparentFriction
        From `stiction.analysis.apparent_friction`.
    ax : Axes, optional
        Drawn on; a new figure as wide as a column when left out.
    """
    phi = np.degrees(found.phi)
    with style():
        ax = panel(ax, COLUMN, 2.6)
        low, high = found.mean - found.amplitude, found.mean + found.amplitude
        ax.fill_between(phi, low, high, color=BLUE, alpha=0.15, linewidth=0)
        ax.plot(phi, found.peak, "^", color=RED, markersize=3.0, label="peak: apparent static")
        label = "mean, and half span: apparent kinetic"
        ax.plot(phi, found.mean, "o-", color=BLUE, markersize=2.6, label=label)
        label = r"steady sliding: $\mu(V) \cos\varphi$"
        ax.plot(phi, found.steady, color=BLACK, linestyle=(0, (4, 1.5)), label=label)
        ax.set_xlabel(r"misalignment $\varphi$ (deg)")
        ax.set_ylabel("force on the soft spring over load (1)")
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return ax
