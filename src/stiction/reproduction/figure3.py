"""Fig. 3: dynamic stiction, slow creep and stick-slip."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stiction.analysis.creep.first_slip import first_slip_time
from stiction.plotting.page.style import BLUE, COLUMN, new_figure, panel_letter, style
from stiction.plotting.run import time_series
from stiction.text.quantity_text import metric_prefix
from stiction.trajectory import Trajectory


def figure3(run: Trajectory) -> Figure:
    """Draw Fig. 3 of Nakano & Popov: forces, friction vector and position over time.

    (a) Spring force along x, (b) along y, (c) magnitude of the friction force, (d) its angle
    to the drive, (e) position, with the creep before the first slip magnified.

    Parameters
    ----------
    run : Trajectory
        The paper's runs 5 s; any other will do.

    Returns
    -------
    Figure
        As wide as a column.
    """
    with style():
        fig = new_figure(COLUMN, 5.6)
        axes = fig.subplots(5, 1, sharex=True, height_ratios=[1, 1, 1, 1, 1.5])
        time_series.draw_spring_force(axes[0], run, "x")
        time_series.draw_spring_force(axes[1], run, "y")
        time_series.draw_friction(axes[2], run)
        time_series.draw_direction(axes[3], run)
        time_series.draw_position(axes[4], run)
        for ax, letter in zip(axes, "abcde", strict=True):
            ax.margins(y=0.12)
            panel_letter(ax, letter)
        _magnify_creep(axes[4], run)
        axes[-1].set_xlabel("time $t$ (s)")
        fig.align_ylabels(axes)
    return fig


def _magnify_creep(ax: Axes, run: Trajectory) -> Axes:
    """Draw, in an inset, how X (um) creeps before the first slip."""
    start, end = float(run.samples["time"][0]), first_slip_time(run)
    stick = run.data.sel(time=slice(start, start + 0.98 * (end - start)))
    inset = ax.inset_axes((0.16, 0.48, 0.36, 0.44))
    factor, prefix = metric_prefix(stick["X"].values)
    time_series.draw_line(inset, stick["time"].values, stick["X"].values * factor, BLUE)
    inset.set_ylabel(f"$X$ ({prefix}m)", fontsize=7, labelpad=1)
    inset.set_xlabel("$t$ (s)", fontsize=7, labelpad=1)
    inset.margins(y=0.08)
    ax.annotate(
        "",
        (0.16 * end, 0.0),
        (0.30, 0.28),
        textcoords="axes fraction",
        arrowprops={"arrowstyle": "->", "linewidth": 0.6},
    )
    return inset
