"""The readings of a rig's test over its uncertain misalignment."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from stiction.plotting.page.canvas import grid_of
from stiction.plotting.page.parameter import in_unit, use_scale
from stiction.plotting.page.style import BLACK, BLUE, GREY, PAGE, PALE, style
from stiction.text.quantity.wording import percent

if TYPE_CHECKING:
    from stiction.auditing.tolerance import Budget

LABELS = (
    "apparent static friction,\nlargest force",
    "apparent kinetic friction,\nmean",
    "creep before slip",
    "transverse oscillation",
)
UNITS = ("1", "1", "m", "m")


def plot_tolerance(budget: Budget, axes: Sequence[Axes] | None = None) -> NDArray[np.object_]:
    """Draw each reading of a rig's tests over the misalignments drawn from its prior.

    Parameters
    ----------
    budget : Budget
        Of `stiction.audit` of a rig with an uncertain misalignment: ``audit(rig).budget``.
    axes : sequence of Axes, optional
        Four; by default a new figure as wide as a page.

    Returns
    -------
    ndarray of Axes
        Static and kinetic coefficient, with the allowed error of the former and the misalignment
        where it is reached; creep and transverse oscillation.
    """
    with style():
        panels = grid_of(axes, (PAGE, 3.6), 2, 2, sharex=True)
        angles = np.degrees(budget.angles)
        for i, ax in enumerate(panels):
            factor, unit = in_unit(budget.drawn[np.isfinite(budget.drawn[:, i]), i], UNITS[i])
            ax.plot(angles, factor * budget.drawn[:, i], "o", color=BLUE, markersize=2.2)
            ends = factor * budget.at_ends[:, i]
            ax.plot(
                np.degrees(budget.ends), ends, "_", color=BLACK, markersize=9.0,
                label="2.5, 50, 97.5 % of angles",
            )  # fmt: skip
            ax.set_ylabel(LABELS[i] + ("" if unit == "1" else f" ({unit})"))
        draw_limit(panels[0], budget)
        use_scale(panels[0], "x", budget.logarithmic)  # the panels share it
        for ax in panels[2:]:
            ax.set_xlabel(r"misalignment $\varphi$ (deg)")
    return np.array(panels, dtype=object)


def draw_limit(ax: Axes, budget: Budget) -> None:
    """Draw the allowed error of the static coefficient, and where it is reached."""
    static, limit = budget.aligned.static, budget.alignment
    band = static * (1.0 - limit.allowed), static * (1.0 + limit.allowed)
    ax.axhspan(
        *band,
        facecolor=PALE,
        edgecolor=GREY,
        linewidth=0.5,
        zorder=0,
        label=f"within {percent(limit.allowed)}",
    )
    reached = np.degrees(limit.angle)
    if np.isfinite(reached):
        side = np.sign(np.median(budget.angles)) or 1.0
        ax.axvline(
            side * reached, color=GREY, linewidth=0.8, linestyle=(0, (4, 2)),
            label=f"error of {percent(limit.allowed)}",
        )  # fmt: skip
    ax.legend(  # above: draws may stand anywhere in the panel
        loc="lower right", bbox_to_anchor=(1.03, 1.0), ncols=2, handlelength=1.0, columnspacing=1.0
    )
