"""Velocity steps: friction over the slip since each jump, with the fitted curves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.axes import Axes

from stiction.plotting.page.canvas import panel
from stiction.plotting.page.style import BLACK, BLUE, COLUMN, GREEN, RED, style
from stiction.text.units import in_words

if TYPE_CHECKING:
    from stiction.analysis.protocols.velocity_steps import VelocitySteps

LOOKS = ((BLUE, "-"), (RED, (0, (4, 1.5))), (GREEN, (0, (1, 1.5))), (BLACK, (0, (6, 1.5, 1, 1.5))))
REACH = 8.0  # D_c of slip that are drawn


def plot_velocity_steps(found: VelocitySteps, ax: Axes | None = None) -> Axes:
    """Draw friction over the slip since each jump of the velocity, and the fitted evolution.

    Parameters
    ----------
    found : VelocitySteps
        From `stiction.analysis.velocity_steps`.
    ax : Axes, optional
        Drawn on; a new figure as wide as a column when left out.
    """
    with style():
        ax = panel(ax, COLUMN, 2.8)
        far = max((REACH * each.D_c for each in found.steps if each.D_c > 0.0), default=None)
        for n, each in enumerate(found.steps):
            color, dashes = LOOKS[n % len(LOOKS)]
            label = f"{in_words(each.before, 'm/s', 3)} to {in_words(each.after, 'm/s', 3)}"
            ax.plot(1e6 * each.slip, each.mu, ".", color=color, markersize=2.0, alpha=0.4)
            ax.plot(1e6 * each.slip, each.fit, color=color, linestyle=dashes, label=label)
            ax.axhline(each.steady_before, color=color, linestyle=dashes, linewidth=0.4)
        if far is not None:
            ax.set_xlim(0.0, 1e6 * far)
        ax.set_xlabel("slip since the step (µm)")
        ax.set_ylabel(r"friction $\mu$ (1)")
        ax.legend(loc="best", title="points: data; lines: fit")
    return ax
