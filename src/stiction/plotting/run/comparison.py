"""Several runs of one apparatus on one page."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from textwrap import wrap

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from stiction.analysis.slip import is_undersampled
from stiction.friction import name_of
from stiction.plotting.page.canvas import canvas, find_drawing, fix_ticks
from stiction.plotting.page.style import GREY, PAGE, style
from stiction.plotting.page.words import (
    MEAN_MOTION,
    parameters_in_words,
    system_in_words,
    wrap_words,
)
from stiction.plotting.run.curves import RunCurve, curves_of, draw_over_time, force_symbol
from stiction.plotting.run.slip_speeds import (
    LAST,
    MANY,
    draw_held,
    draw_portrait,
    draw_rests,
    draw_speeds,
    set_limits,
)
from stiction.plotting.run.time_series import fastest_drive, slipping
from stiction.trajectory import Trajectory

WIDTH = 44  # characters of a legend's line
LINE = 8.4 / 72  # in
NOTE = (
    "Broad line: the described law. Pale bands: the",
    "range of fast swings about their mean (line); of",
    "the slip speed, from its mean up to its maximum.",
    f"Loops: of more than {MANY} cycles the last {LAST}.",
    "Rows below: share of time at zero slip.",
)


def plot_comparison(
    runs: Mapping[str, Trajectory], axes: Mapping[str, Axes] | None = None
) -> dict[str, Axes]:
    """Draw runs of one apparatus together: force, position, slip speed, phase portrait.

    Slip speed is on a logarithmic axis: a line for the mean over a 500th of the time, a pale
    band up to the maximum, which stands out where slip comes in bursts. Zero slip has no place
    on that axis: below it, each run has a row that is filled as high as the share of time in
    which the mass rests.

    Parameters
    ----------
    runs : mapping of str to Trajectory
        The runs by label, e.g. from `stiction.compare`.
    axes : mapping of str to Axes, optional
        What to draw, and where: any of "force", "X", "speed", "rest", "portrait", "held" and
        "words". All, on a new figure as wide as a page, when left out.

    Returns
    -------
    dict of str to Axes
        The axes by their names.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> base = st.Description(slider, st.Initial(), st.Settings(duration="20 ms"))
    >>> axes = st.plotting.plot_comparison(st.compare(base, ["coulomb"]))
    """
    with style():
        curves = curves_of(runs)
        legend = [legend_text(curve) for curve in curves]
        symbol = force_symbol(curves[0].run.slider)
        panels = dict(_panels(curves, legend) if axes is None else axes)
        draw: dict[str, Callable[[Axes], None]] = {
            "force": lambda ax: draw_over_time(ax, curves, "force", symbol),
            "X": lambda ax: draw_over_time(ax, curves, "X", "$X$"),
            "speed": lambda ax: draw_speeds(ax, curves),
            "portrait": lambda ax: draw_portrait(ax, curves),
            "rest": lambda ax: draw_rests(ax, curves),
            "held": lambda ax: draw_held(ax, curves),
            "words": lambda ax: write_legend(ax, curves, legend),
        }
        for name, ax in panels.items():
            find_drawing(draw, name)(ax)
        for name in {"speed", "portrait"} & panels.keys():
            set_limits(panels[name], curves)
        if axes is None:
            _align(panels)
    return panels


def _panels(curves: list[RunCurve], legend: list[str]) -> dict[str, Axes]:
    """Return the axes of a new figure, by their names."""
    lines = sum(text.count("\n") + 1.6 for text in legend) + 10
    top, strip = max(2.3, lines * LINE), 0.08 + 0.1 * len(curves)
    panels: dict[str, Axes] = canvas(PAGE, top + 2.5 + strip).subplot_mosaic(
        [["force", "words"], ["X", "words"], ["speed", "portrait"], ["rest", "held"]],
        width_ratios=[1.6, 1],
        height_ratios=[top / 2, top / 2, 2.2, strip],
    )
    fix_ticks([*panels.values()])
    return panels


def _align(ax: Mapping[str, Axes]) -> None:
    """Let panels above each other share the labels below them."""
    for name in ("force", "X", "speed"):
        ax[name].set_xlim(ax["rest"].get_xlim())
        ax[name].tick_params(labelbottom=False)
    ax["portrait"].set_xlim(ax["held"].get_xlim())
    ax["portrait"].tick_params(which="both", labelbottom=False, labelleft=False)
    ax["force"].figure.align_ylabels([ax[name] for name in ("force", "X", "speed", "rest")])


def legend_text(curve: RunCurve) -> str:
    """Return the legend of a run: its name, its law's parameters, an early end."""
    law = curve.run.slider.law
    name = name_of(law)
    bare = curve.label.startswith(f"{name}, ")  # parameters follow, which are written below
    heading = [name] if bare else wrap(curve.label, WIDTH)
    lines = [*heading, *wrap_words(parameters_in_words(law), WIDTH)]
    if not curve.run.status.ok:
        end = float(curve.run.samples["time"][-1])
        reason = curve.run.status.name.lower().replace("_", " ")
        lines.append(f"× ended early at {end:.4g} s: {reason}")
    if slipping(curve.slip, fastest_drive(curve.run)) is None:
        lines.append("no slip")
    if is_undersampled(curve.run):
        lines += wrap(MEAN_MOTION, WIDTH)
    return "\n".join(lines)


def write_legend(ax: Axes, curves: list[RunCurve], texts: list[str]) -> None:
    """Write the legend of lines and band, and the system that all runs share."""
    ax.set_axis_off()
    handles = [Line2D([], [], **curve.look) for curve in curves]
    legend = ax.legend(
        handles,
        texts,
        loc="upper left",
        bbox_to_anchor=(0.0, 1.0),
        borderaxespad=0.0,
        labelspacing=0.6,
        handlelength=2.6,
        fontsize=6.5,
    )
    legend.set_in_layout(False)
    system = "\n".join([*system_in_words(curves[0].run.slider), "", *NOTE])
    note = ax.text(0.0, 0.0, system, transform=ax.transAxes, fontsize=6.5, color=GREY, va="bottom")
    note.set_in_layout(False)
