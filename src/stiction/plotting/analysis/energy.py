"""The energy budget, interval by interval."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import NullFormatter
from numpy.typing import NDArray

from stiction.arrays import Floats, xr
from stiction.plotting.page.canvas import stack
from stiction.plotting.page.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    panel_letter,
    style,
)
from stiction.plotting.run.time_series import name_time
from stiction.text.quantity.prefix import metric_prefix

# terms of the budget: label, colour, hatch, whether dissipated
ENERGY_TERMS = {
    "friction_x": ("friction, $x$", RED, ""),
    "friction_y": ("friction, $y$", ORANGE, "////"),
    "damper_x": ("damper, $x$", PURPLE, ""),
    "damper_y": ("damper, $y$", GREY, "////"),
    "spring_x": ("spring, $x$", BLUE, ""),
    "spring_y": ("spring, $y$", SKY, "////"),
    "kinetic": ("kinetic", GREEN, "...."),
}


def draw_budget(ax: Axes, budget: xr.Dataset) -> None:
    """Draw the terms of each interval, stacked; released energy points down.

    Black ticks beside it mark the work of the drive. Parts below a thousandth of the largest
    are left out.
    """
    named = {name: budget[name].values for name in ENERGY_TERMS}
    factor, prefix = metric_prefix(np.concatenate([*named.values(), budget["work"].values]))
    largest = max(float(np.abs(values).max()) for values in named.values())
    ax.use_sticky_edges = False  # a part of no height would hold the axis to the top of its bar
    place, wide = middles(budget)
    up, down = np.zeros(len(place)), np.zeros(len(place))
    for name, values in named.items():
        label, color, hatch = ENERGY_TERMS[name]
        if np.abs(values).max() < 1e-3 * largest:
            continue
        bottom = np.where(values >= 0.0, up, down)
        ax.bar(
            place, factor * values, 0.7 * wide, factor * bottom, label=label, color=color,
            hatch=hatch, edgecolor="white", linewidth=0.0,
        )  # fmt: skip
        up, down = up + np.maximum(values, 0.0), down + np.minimum(values, 0.0)
    work = factor * budget["work"].values
    half = 0.45 * wide
    ax.hlines(
        work, place - half, place + half, color=BLACK, linewidth=1.6, label="work of the drive"
    )
    ax.axhline(0.0, color=BLACK, linewidth=0.6)
    ax.set_ylabel(f"energy ({prefix}J)")


def middles(budget: xr.Dataset) -> tuple[Floats, Floats]:
    """Return the middle and the length of each interval, s."""
    start, end = budget["start"].values, budget["end"].values
    return 0.5 * (start + end), end - start


def draw_closure(ax: Axes, budget: xr.Dataset) -> None:
    """Draw the residual of each interval as a share of the total work."""
    place, _ = middles(budget)
    whole = float(np.abs(budget["work"].values).sum()) or 1.0
    ax.semilogy(
        place, np.abs(budget["residual"].values) / whole, "o", color=BLACK, ms=3, label="residual"
    )
    bound = budget["bound"].values / whole
    ax.semilogy(place, bound, "_", color=RED, ms=9, mew=1.2, label="its bound")
    shown = np.concatenate([np.abs(budget["residual"].values) / whole, np.ravel(bound)])
    decades = np.log10(shown[np.isfinite(shown) & (shown > 0.0)])
    if len(decades):  # label whole decades only
        ax.set_ylim(10.0 ** np.floor(decades.min() - 0.1), 10.0 ** np.ceil(decades.max() + 0.1))
    ax.yaxis.set_minor_formatter(NullFormatter())
    ax.set_ylabel("share of work (1)")


def plot_energy(budget: xr.Dataset, axes: Sequence[Axes] | None = None) -> NDArray[np.object_]:
    """Draw an energy budget: (a) its terms, (b) its residual.

    Parameters
    ----------
    budget : Dataset
        From `stiction.analysis.energy_budget`, with some intervals, e.g. cycles.
    axes : sequence of Axes, optional
        Two, drawn on; by default a new figure as wide as a column.

    Returns
    -------
    ndarray of Axes
        The two.
    """
    with style():
        panels = stack(axes, 4.3, (1.8, 1.0))
        draw_budget(panels[0], budget)
        draw_closure(panels[1], budget)
        for ax, letter in zip(panels, "ab", strict=True):
            panel_letter(ax, letter)
        panels[0].legend(loc="lower center", bbox_to_anchor=(0.5, 1.07), ncols=3)
        panels[1].legend(loc="best")
        panels[1].set_xlim(budget["start"].values[0], budget["end"].values[-1])
        name_time(panels[1])
    return np.array(panels, dtype=object)
