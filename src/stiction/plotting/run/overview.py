"""A whole run on one page, or at a glance."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.patches import Patch

from stiction.analysis.measurement.excerpt import excerpt
from stiction.arrays import Floats
from stiction.plotting.apparatus.schematic import draw_schematic
from stiction.plotting.page.canvas import canvas, find_drawing, fix_ticks, panels_by_name
from stiction.plotting.page.style import BLACK, BLUE, GREY, ORANGE, PAGE, RED, style
from stiction.plotting.page.words import (
    law_in_words,
    outcome_in_words,
    scales_in_words,
    system_in_words,
)
from stiction.plotting.run import time_series
from stiction.plotting.run.law import draw_law
from stiction.plotting.run.lines import BAND, draw_line
from stiction.text.quantity.prefix import metric_prefix
from stiction.text.units import Quantity
from stiction.trajectory import Trajectory

LINE, GAP = 10.5, 3.0  # of text, pt
DRAWING, LAW = 2.1, 1.7  # heights of the system's drawing and of the law, in

SERIES = {  # and their heights relative to each other
    "force": 1.4, "friction": 1.0, "direction": 1.0, "position": 1.0, "speed": 1.2, "stuck": 0.6,
}  # fmt: skip
SHOWN_PANELS = ("force", "direction", "speed")
HEIGHT = 1.9  # in


def plot_run(
    run: Trajectory,
    axes: Mapping[str, Axes] | None = None,
    *,
    window: Sequence[Quantity] | None = None,
) -> dict[str, Axes]:
    """Draw a run: the system, its parameters, its end, and its motion over time.

    Friction law, spring forces, magnitude and direction of the friction force, position, slip
    speed, and the share of time stuck, which counts every stick interval however short.

    Parameters
    ----------
    run : Trajectory
        Any run, complete or not.
    axes : mapping of str to Axes, optional
        What to draw, and where: any of "system", "words", "law", "drive_X", "drive_Y",
        "normal_load" (where these change), "force", "friction", "direction", "position",
        "speed", "stuck". By default all on a new figure as wide as a page, without "direction"
        of an aligned rig, whose friction never turns, and "stuck" where nothing sticks.
    window : tuple of float or str, optional
        Start and end in the run, s; all of it by default.

    Returns
    -------
    dict of str to Axes
        The axes by their names.

    Raises
    ------
    ResultError
        If there is no such window, or fewer than two samples lie in it.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "20 ms", sample_rate="10 kHz")
    >>> run.plot()["force"].get_ylabel()
    'spring force (N)'
    >>> run.plot(window=("5 ms", "10 ms"))["force"].get_xlim()
    (np.float64(0.005), np.float64(0.01))
    """
    part = excerpt(run, window)
    words = _words(run, part)
    with style():
        panels = _panels(part, words) if axes is None else panels_by_name(axes)
        drawings: dict[str, Callable[[Axes, Trajectory], Any]] = {
            "system": lambda ax, run: draw_schematic(ax, run.slider),
            "words": lambda ax, _: _write(ax, words),
            "law": _law,
            **_series(part),
        }
        for name, ax in panels.items():
            find_drawing(drawings, name)(ax, part)
        series = [ax for name, ax in panels.items() if name not in ("system", "words", "law")]
        if axes is None:
            for ax in series[:-1]:
                ax.set_xlabel("")
            series[0].figure.align_ylabels(series)
    return panels


Words = list[tuple[str, list[str], str]]  # headings, lines below them, and their colour


def _panels(run: Trajectory, words: Words) -> dict[str, Axes]:
    """Return the axes of a new figure, by their names."""
    written = sum(GAP + LINE * (1 + len(lines)) for _, lines, _ in words) / 72 + 0.3
    fig = canvas(PAGE, max(6.2, DRAWING + written + LAW + 0.1))
    left, right = fig.subfigures(1, 2, squeeze=False, width_ratios=[1, 1.55])[0]
    panels = left.subplot_mosaic(
        [["system"], ["words"], ["law"]], height_ratios=[DRAWING, written, LAW]
    )
    imposed = [name for name, *_ in time_series.imposed_quantities(run)]
    heights = dict.fromkeys(imposed, 0.85) | {name: SERIES[name] for name in _moving(run)}
    series = right.subplots(len(heights), 1, sharex=True, height_ratios=[*heights.values()])
    fix_ticks([*panels.values(), *series])
    return {**panels, **dict(zip(heights, series, strict=True))}


def _moving(run: Trajectory) -> list[str]:
    """Return the names of the series without those that would be empty: no turn, no stick.

    The words beside them tell that the rig is aligned, or that nothing sticks.
    """
    empty = set()
    if run.slider.misalignment == 0.0 and not time_series.friction_turns(run):
        empty.add("direction")
    if not len(run.stick_intervals):
        empty.add("stuck")
    return [name for name in SERIES if name not in empty]


def _law(ax: Axes, run: Trajectory) -> None:
    drive = run.slider.drive_speed  # the slip speed of steady sliding
    draw_law(ax, run.slider, max(drive, float(np.nanmax(run.samples["slip_speed"]))))


def _words(run: Trajectory, part: Trajectory) -> Words:
    """Return the text beside a run, a part of which is drawn."""
    return [
        ("System", system_in_words(run.slider), BLACK),
        ("Friction", law_in_words(run.slider), BLACK),
        ("Scales", scales_in_words(run.slider), BLACK),
        ("Run", outcome_in_words(run, part), BLUE if run.status.ok else RED),
    ]


def _series(run: Trajectory) -> dict[str, Callable[[Axes, Trajectory], Any]]:
    """Return the functions that draw each quantity over time, by name."""

    def with_margins(draw: Callable[[Axes, Trajectory], Any]) -> Callable[[Axes, Trajectory], Any]:
        def draw_series(ax: Axes, run: Trajectory) -> None:
            draw(ax, run)
            ax.set_xlabel("time $t$ (s)")
            times = run.samples["time"]
            if times[-1] > times[0]:
                ax.set_xlim(times[0], times[-1])
                time_series.name_years(ax)
            if draw not in (time_series.draw_slip_speed, time_series.draw_time_stuck):
                ax.margins(y=0.12)

        return draw_series

    def draw_imposed(values: Floats, symbol: str, unit: str) -> Callable[[Axes, Trajectory], Any]:
        return lambda ax, run: time_series.draw_values(ax, run, values, symbol, unit)

    drawings = (
        _forces,
        time_series.draw_friction,
        time_series.draw_direction,
        time_series.draw_position,
        time_series.draw_slip_speed,
        time_series.draw_time_stuck,
    )
    found = {each[0]: draw_imposed(*each[1:]) for each in time_series.imposed_quantities(run)}
    named: dict[str, Callable[[Axes, Trajectory], Any]] = {
        **found,
        **dict(zip(SERIES, drawings, strict=True)),
    }
    return {name: with_margins(draw) for name, draw in named.items()}


def _forces(ax: Axes, run: Trajectory) -> None:
    """Draw both spring forces."""
    forces = [run.samples[f"spring_{axis}"] for axis in "xy"]
    factor, prefix = metric_prefix(np.concatenate(forces))
    times = run.samples["time"]
    whole = np.concatenate(forces) * factor
    height = float(np.fmax.reduce(whole) - np.fmin.reduce(whole))
    window = float(times[-1] - times[0]), height  # of both: that of one may be rounding alone
    for axis, color, force in zip("xy", (RED, ORANGE), forces, strict=True):
        line = draw_line(ax, times, force * factor, color, window=window)
        line.set_label(f"$k_{axis} u_{axis}$")
        line.set_zorder(2.2 if axis == "x" else 2.0)  # the transverse force would hide it
    ax.set_ylabel(f"spring force ({prefix}N)")
    handles: list[Artist] = [*ax.get_lines()]
    if ax.collections:
        band = Patch(color=GREY, alpha=BAND, linewidth=0, label="fast oscillation")
        handles.append(band)
    ax.legend(
        handles=handles, loc="lower right", ncols=3, bbox_to_anchor=(1.0, 0.97), borderaxespad=0.0
    )


def _write(ax: Axes, words: Words) -> None:
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


def plot_glance(run: Trajectory, axes: Mapping[str, Axes] | None = None) -> dict[str, Axes]:
    """Draw a run small: spring forces, direction of friction, slip speed.

    Parameters
    ----------
    run : Trajectory
        Any run.
    axes : mapping of str to Axes, optional
        As of `stiction.plotting.plot_run`; by default a new figure as wide as a page.

    Returns
    -------
    dict of str to Axes
        The axes by their names.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "0.1 s", sample_rate="10 kHz")
    >>> axes = st.plotting.plot_glance(run)
    """
    with style():
        panels = axes
        if panels is None:
            made = canvas(PAGE, HEIGHT).subplots(1, len(SHOWN_PANELS))
            panels = dict(zip(SHOWN_PANELS, fix_ticks(list(made)), strict=True))
    return plot_run(run, panels)
