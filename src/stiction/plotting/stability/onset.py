"""The onset of an oscillation: its amplitude over a parameter, swept up and down."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from stiction.analysis.limit_cycle import OSCILLATING, REST, UNDECIDED
from stiction.analysis.onset import Onset
from stiction.arrays import Floats
from stiction.plotting.page.canvas import panel
from stiction.plotting.page.parameter import PLAIN, scale_of
from stiction.plotting.page.style import BLUE, GREY, PALE, RED, style
from stiction.text.quantity.prefix import metric_prefix

LOOKS: dict[str, dict[str, Any]] = {
    "up": {"color": BLUE, "marker": "^", "markersize": 4.0},
    "down": {"color": RED, "marker": "v", "markersize": 4.0, "markerfacecolor": "white"},
}
SPREAD = 30.0  # ratio of amplitudes beyond which their axis is logarithmic


def plot_onset(onset: Onset, critical: float | None = None, ax: Axes | None = None) -> Axes:
    """Draw the amplitude of the oscillation, swept up and down.

    Parameters
    ----------
    onset : Onset
        From `stiction.analysis.find_onset`.
    critical : float, optional
        The onset by linear theory, SI, from `stiction.linear_stability.critical`.
    ax : Axes, optional
        Drawn on; by default a new figure as wide as a column.
    """
    with style():
        ax = panel(ax, 2.7)
        draw_onset(ax, onset, critical)
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    return ax


def draw_onset(ax: Axes, onset: Onset, critical: float | None = None) -> None:
    """Draw both sweeps; rest on the lower edge, hysteresis shaded, undecided runs as crosses.

    Where amplitudes span more than a factor of thirty their axis is logarithmic.
    """
    data = onset.data
    values, amplitude, outcome = (data[name].values for name in ("value", "amplitude", "outcome"))
    scale = scale_of(data["value"].attrs["long_name"], data["value"].attrs["units"], values)
    factor, bottom = _set_amplitudes(ax, amplitude[outcome == OSCILLATING])
    at = scale.in_unit(values)
    for sweep, (name, look) in enumerate(LOOKS.items()):
        size = np.fmax(amplitude[sweep] * factor, bottom)
        size[outcome[sweep] == REST] = bottom
        known = outcome[sweep] != UNDECIDED
        ax.plot(at[known], size[known], label=f"swept {name}", clip_on=False, zorder=3, **look)
        unsure = {**look, "marker": "x", "linestyle": "none"}
        ax.plot(at[~known], size[~known], clip_on=False, zorder=4, **unsure)
    if (outcome == UNDECIDED).any():
        ax.plot([], [], "x", color=GREY, markersize=4.0, label="undecided")
    rests = (outcome == REST).all(axis=0)
    if rests.any():
        _write(ax, float(np.median(at[rests])), bottom, "rest")
    if onset.kind == "hard" and np.isfinite(onset.hysteresis).all():
        ax.axvspan(*scale.in_unit(onset.hysteresis), color=PALE, zorder=0, label="hysteresis")
    if critical is not None:
        label = f"linear: {scale.quantity(critical)}"
        ax.axvline(critical * scale.factor, color=GREY, dashes=(4, 2), label=label)
    ax.set_xlabel(scale.label)
    ax.margins(x=0.03)


def _set_amplitudes(ax: Axes, moving: Floats) -> tuple[float, float]:
    """Fit the axis to amplitudes (m); return the factor to its unit, and its lower edge."""
    top, least = (each(moving, initial=start) for each, start in ((np.max, 0.0), (np.min, np.inf)))
    logarithmic = 0.0 < SPREAD * least < top
    factor, prefix = metric_prefix(np.sqrt(top * least) if logarithmic else top)
    ax.set_ylabel(f"amplitude along the drive ({prefix}m)")
    if not logarithmic:
        ax.set_ylim(0.0, 1.15 * top * factor or 1.0)
        return factor, 0.0
    bottom = float(0.4 * least * factor)
    ax.set(yscale="log", ylim=(bottom, 2.5 * top * factor))
    ax.yaxis.set_major_formatter(PLAIN)
    return factor, bottom


def _write(ax: Axes, x: float, y: float, text: str) -> None:
    ax.annotate(text, (x, y), (0, 6), textcoords="offset points", ha="center", va="bottom")
