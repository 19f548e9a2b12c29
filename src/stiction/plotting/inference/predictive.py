"""A measured record beside simulations with the fitted parameters, and ranks of a calibration."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from stiction.plotting.inference.posterior import panels_of
from stiction.plotting.page.canvas import as_list, canvas, fix_ticks
from stiction.plotting.page.style import BLACK, BLUE, GREY, PAGE, PALE, SKY, style
from stiction.text.quantity_text import metric_prefix

SHOWN = 5  # cycles
BINS = 10


def plot_predictive(comparison: Any, axes: Sequence[Axes] | None = None) -> NDArray[np.object_]:
    """Draw a record over a simulation with the fitted parameters, and both loading curves.

    Parameters
    ----------
    comparison : Comparison
        Of `stiction.audit` of a rig and a record: ``audit(rig, record=record).measured``.
    axes : sequence of Axes, optional
        Three; a new figure as wide as a page when left out.

    Returns
    -------
    ndarray of Axes
        Force over time, from a trough on; loading curves with the 95 % predictive band; how far
        they are from straight.
    """
    with style():
        if axes is None:
            axes = fix_ticks(list(canvas(PAGE, 2.4).subplots(1, 3, width_ratios=(1.4, 1, 1))))
        panels = as_list(axes)
        draw_cycles(panels[0], comparison.seen, comparison.predictive)
        draw_loading(panels[1:], comparison.predictive)
        for ax in panels[:2]:  # both curves fill the panels
            ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    return np.array(panels, dtype=object)


def draw_cycles(ax: Axes, seen: Any, found: Any) -> None:
    """Draw some cycles of a record over those of a simulation."""
    factor, prefix = metric_prefix(found.measured.force)
    step = seen.conditions.step
    example = found.example.channels["force"], found.example.cycles
    for (force, cycles), color, width, label in (
        (example, SKY, 1.8, "simulated"),
        ((seen.force, seen.cycles), BLACK, 0.7, "measured"),
    ):
        part = factor * force[cycles.before[0] : cycles.after[min(SHOWN, len(cycles.after)) - 1]]
        ax.plot(step * np.arange(len(part)), part, color=color, linewidth=width, label=label)
    ax.set(xlabel="time from a trough (s)", ylabel=f"force ({prefix}N)")


def draw_loading(panels: Sequence[Axes], found: Any) -> None:
    """Draw loading curves and their bend, each with its predictive band."""
    factor, prefix = metric_prefix(found.measured.force)
    time, names = found.simulated.time.mean(axis=0), ("force", "bend")
    for ax, name, scale, (low, high) in zip(
        panels, names, (factor, 100.0), found.bands, strict=True
    ):
        ax.fill_between(time, scale * low, scale * high, color=PALE, label="simulated, 95 %")
        mean = getattr(found.simulated, name).mean(axis=0)
        ax.plot(time, scale * mean, color=BLUE, linewidth=0.8)
        measured = found.measured
        ax.plot(measured.time, scale * getattr(measured, name), color=BLACK, label="measured")
        ax.set(xlabel="time in the mean loading (s)")
    panels[0].set_ylabel(f"force ({prefix}N)")
    panels[1].set_ylabel("from a straight line (% of the rise)")


def plot_ranks(fit: Any, axes: Sequence[Axes] | None = None) -> NDArray[np.object_]:
    """Draw the ranks of the truth in posteriors of simulated records: even, if calibrated.

    Parameters
    ----------
    fit : Fit
        From `stiction.fit`.
    axes : sequence of Axes, optional
        One for each parameter; a new figure as wide as a page when left out.

    Returns
    -------
    ndarray of Axes
        One for each parameter; grey, where 95 % of the counts lie if ranks are uniform.
    """
    from scipy.stats import binom  # type: ignore[attr-defined]

    names = [*fit.data.data_vars]
    low, high = binom.ppf([0.025, 0.975], len(fit.ranks), 1.0 / BINS)
    with style():
        panels = panels_of(axes, len(names), 1.3)
        for ax, name, ranks in zip(panels, names, fit.ranks.T, strict=True):
            ax.axhspan(low, high, color=PALE, zorder=0)
            edges = np.linspace(0.0, 1.0, BINS + 1).tolist()
            ax.hist(ranks, edges, histtype="step", color=BLUE)
            ax.axhline(len(ranks) / BINS, color=GREY, linewidth=0.6)
            ax.set(xlim=(0.0, 1.0), ylim=(0.0, 2.0 * high), yticks=[], title=name)
    return np.array(panels, dtype=object)
