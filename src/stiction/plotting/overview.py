"""A whole run on one page."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from stiction.plotting import time_series
from stiction.plotting.law import draw_law
from stiction.plotting.schematic import draw_schematic
from stiction.plotting.style import BLACK, BLUE, ORANGE, PAGE, RED, new_figure, style
from stiction.plotting.words import (
    base_velocity,
    law_in_words,
    outcome_in_words,
    scales_in_words,
    system_in_words,
)
from stiction.trajectory import Trajectory

LINE, GAP = 10.5, 3.0  # of what is written, pt
DRAWING, LAW = 2.1, 1.7  # heights of the system's drawing and of the law, in


def overview(run: Trajectory) -> Figure:
    """Draw a run: the system, its parameters, how it ended, and what it did over time.

    Friction law, spring forces, magnitude and direction of the friction force, position, slip
    speed, and the share of time stuck, which counts every stick interval however short.

    Parameters
    ----------
    run : Trajectory
        Any run, of any system, ended well or not.

    Returns
    -------
    Figure
        As wide as a page.
    """
    words = _words(run)
    written = sum(GAP + LINE * (1 + len(lines)) for _, lines, _ in words) / 72 + 0.3
    with style():
        fig = new_figure(PAGE, max(6.2, DRAWING + written + LAW + 0.1))
        left, right = fig.subfigures(1, 2, squeeze=False, width_ratios=[1, 1.55])[0]
        panels = left.subplot_mosaic(
            [["system"], ["words"], ["law"]], height_ratios=[DRAWING, written, LAW]
        )
        draw_schematic(panels["system"], run.slider)
        _write(panels["words"], words)
        drive = abs(base_velocity(run.slider))  # what slips when nothing else does
        draw_law(panels["law"], run.slider, max(drive, float(run.data["slip_speed"].max())))
        _draw_series(right, run)
    return fig


def _words(run: Trajectory) -> list[tuple[str, list[str], str]]:
    """Return what is written: headings, lines below them, and their colour."""
    return [
        ("System", system_in_words(run.slider), BLACK),
        ("Friction", law_in_words(run.slider), BLACK),
        ("Scales", scales_in_words(run.slider), BLACK),
        ("Run", outcome_in_words(run), BLUE if run.status.ok else RED),
    ]


def _draw_series(figure: SubFigure, run: Trajectory) -> None:
    """Draw what was done to the system, where it changes, and what the system did."""
    imposed = time_series.imposed(run)
    heights = [0.85] * len(imposed) + [1.4, 1, 1, 1, 1.2, 0.6]
    series = figure.subplots(len(heights), 1, sharex=True, height_ratios=heights)
    for ax, (values, symbol, unit) in zip(series, imposed, strict=False):
        time_series.draw_values(ax, run, values, symbol, unit)
    forces, friction, direction, position, speed, stuck = series[len(imposed) :]
    factor, prefix = time_series.prefixed(
        abs(run.data["spring_x"].values) + abs(run.data["spring_y"].values)
    )
    times = run.data["time"].values
    for axis, color in (("x", RED), ("y", ORANGE)):
        values = run.data[f"spring_{axis}"].values * factor
        line = time_series.draw_line(forces, times, values, color)
        line.set_label(f"$k_{axis} u_{axis}$")
        line.set_zorder(2.2 if axis == "x" else 2.0)  # what swings across would hide it
    forces.set_ylabel(f"spring force ({prefix}N)")
    forces.legend(loc="lower right", ncols=2, bbox_to_anchor=(1.0, 0.97), borderaxespad=0.0)
    time_series.draw_friction(friction, run)
    time_series.draw_direction(direction, run)
    time_series.draw_position(position, run)
    time_series.draw_slip_speed(speed, run)
    time_series.draw_time_stuck(stuck, run)
    for ax in series[:-2]:
        ax.margins(y=0.12)
    stuck.set_xlabel("time $t$ (s)")
    if times[-1] > times[0]:
        stuck.set_xlim(times[0], times[-1])
    figure.align_ylabels(series)


def _write(ax: Axes, words: list[tuple[str, list[str], str]]) -> None:
    ax.set_axis_off()
    offset = 0.0
    for heading, lines, color in words:
        for line in (heading, *lines):
            text = ax.annotate(
                line,
                (0, 1),
                (0 if line == heading else 6, -offset),
                xycoords="axes fraction",
                textcoords="offset points",
                va="top",
                color=BLACK if line == heading else color,
                fontweight="bold" if line == heading else "normal",
                fontsize=7.5,
            )
            text.set_in_layout(False)
            offset += LINE
        offset += GAP
