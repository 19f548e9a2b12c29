"""A whole run on one page."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stiction.plotting import time_series
from stiction.plotting.law import draw_law
from stiction.plotting.schematic import draw_schematic
from stiction.plotting.style import BLACK, BLUE, ORANGE, PAGE, RED, new_figure, style
from stiction.plotting.words import law_in_words, outcome_in_words, scales_in_words, system_in_words
from stiction.trajectory import Trajectory


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
    with style():
        fig = new_figure(PAGE, 6.2)
        left, right = fig.subfigures(1, 2, squeeze=False, width_ratios=[1, 1.55])[0]
        panels = left.subplot_mosaic(
            [["system"], ["words"], ["law"]], height_ratios=[2.1, 2.3, 1.3]
        )
        system, words, law = (panels[name] for name in ("system", "words", "law"))
        draw_schematic(system, run.slider)
        _write(words, run)
        drive = abs(run.slider.motion.rate(0.0)[0])  # what slips when nothing else does
        draw_law(law, run.slider, max(drive, float(run.data["slip_speed"].max())))
        law.set_title(f"Friction law: {law_in_words(run.slider)}")
        series = right.subplots(6, 1, sharex=True, height_ratios=[1.4, 1, 1, 1, 1.2, 0.6])
        _draw_series(series, run)
        right.align_ylabels(series)
    return fig


def _draw_series(series: Sequence[Axes], run: Trajectory) -> None:
    forces, friction, direction, position, speed, stuck = series
    factor, prefix = time_series.prefixed(
        abs(run.data["spring_x"].values) + abs(run.data["spring_y"].values)
    )
    times = run.data["time"].values
    for axis, color in (("x", RED), ("y", ORANGE)):
        values = run.data[f"spring_{axis}"].values * factor
        line = time_series.draw_line(forces, times, values, color)
        line.set_label(f"$k_{axis} u_{axis}$")
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


def _write(ax: Axes, run: Trajectory) -> None:
    """Write the system, what follows from it, and how the run ended."""
    ax.set_axis_off()
    offset = 0.0
    for heading, lines, color in (
        ("System", system_in_words(run.slider), BLACK),
        ("Scales", scales_in_words(run.slider), BLACK),
        ("Run", outcome_in_words(run), BLUE if run.status.ok else RED),
    ):
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
            offset += 10.5
        offset += 3.0
