"""Several runs of one apparatus on one page."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from textwrap import wrap

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from stiction.analysis.measurement.excerpt import excerpts
from stiction.analysis.motion.cycles import find_cycles
from stiction.analysis.motion.rest import stuck_until
from stiction.analysis.slip import cell_force, is_undersampled
from stiction.errors import StictionError
from stiction.friction import name_of
from stiction.plotting.page.canvas import canvas, find_drawing, fix_ticks, panels_by_name
from stiction.plotting.page.style import GREY, PAGE, style
from stiction.plotting.page.words import (
    MEAN_MOTION,
    parameters_in_words,
    system_in_words,
    wrap_words,
)
from stiction.plotting.run.curves import (
    RunCurve,
    common,
    curves_of,
    draw_curve,
    draw_over_time,
    fit_time,
    force_symbol,
    mark_early_end,
)
from stiction.plotting.run.lines import EDGE
from stiction.plotting.run.time_series import (
    fastest_drive,
    name_years,
    say_only,
    set_speed_limits,
    slipping,
)
from stiction.text.units import Quantity
from stiction.trajectory import Trajectory

WIDTH = 44  # characters of a legend's line
LINE = 8.4 / 72  # in
MANY, LAST = 8, 5  # cycles: of a run with more than the first, only the last ones are seen apart
NOTE = (
    "Broad line: the described law. Pale bands: the",
    "range of fast swings about their mean (line); of",
    "creep, from its mean up to its largest speed.",
    f"Loops: of more than {MANY} cycles the last {LAST}.",
    "Rows below: share of time at zero slip.",
)
ROW = 0.8  # height of a filled row
KEY = (-0.075, -0.01)  # in widths of the panel, the line beside a row that names its run
IN_TIME, BY_FORCE = 300, 120  # bins of a row over time and over force


def plot_comparison(
    runs: Mapping[str, Trajectory],
    axes: Mapping[str, Axes] | None = None,
    *,
    window: Sequence[Quantity] | None = None,
) -> dict[str, Axes]:
    """Draw runs of one apparatus together: force, position, slip speed, phase portrait.

    Slip speed is on a logarithmic axis: a line for the mean over a 500th of the time, a pale
    band up to the maximum, which stands out where slip comes in bursts. Zero slip has no place
    on that axis: below it, each run has a row that is filled as high as the share of time in
    which the mass rests. The line beside a row is that of its run.

    Parameters
    ----------
    runs : mapping of str to Trajectory
        The runs by label, e.g. from `stiction.compare`.
    axes : mapping of str to Axes, optional
        What to draw, and where: any of "force", "X", "speed", "rest", "portrait", "held" and
        "words". All, on a new figure as wide as a page by default.
    window : tuple of float or str, optional
        Start and end in the runs, s; all of them by default.

    Returns
    -------
    dict of str to Axes
        The axes by their names.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> base = st.Description.of(slider, "20 ms")
    >>> axes = st.plotting.plot_comparison(st.compare(base, ["coulomb"]))
    """
    if not runs:
        raise StictionError("there is no run to compare; give some, as `st.compare` returns them")
    with style():
        curves = curves_of(excerpts(runs, window))
        legend = [legend_text(curve) for curve in curves]
        symbol = force_symbol(curves[0].run.slider)
        panels = _panels(curves, legend) if axes is None else panels_by_name(axes)
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


def draw_speeds(ax: Axes, curves: Sequence[RunCurve]) -> None:
    """Draw the slip speed (m/s) over time: its mean, and a band up to its maximum.

    The minimum is not drawn: it is zero wherever the mass comes to rest.
    """
    ax.set_yscale("log", nonpositive="mask")
    ax.set_ylabel(r"$v_\mathrm{slip}$ (m/s)")
    for curve in curves:
        slip, mean = curve.slip, curve.speed
        band = ax.fill_between(slip.time, mean, slip.high, color=curve.color, linewidth=EDGE)
        band.set_facecolor((curve.color, 0.18))
        draw_curve(ax, curve, slip.time, mean)
        mark_early_end(ax, curve, slip.time[-1], mean[-1])
    fit_time(ax, curves)


def _portrayed_from(run: Trajectory) -> float:
    """Return the time from which a phase portrait shows a run, s: its last cycles, if it has many.

    Loops of many irregular cycles would cover each other.
    """
    starts = find_cycles(run)["start"].values
    return float(starts[-LAST] if len(starts) > MANY else run.samples["time"][0])


def draw_portrait(ax: Axes, curves: Sequence[RunCurve]) -> None:
    """Draw the mean slip speed (m/s) over the spring force; of many cycles, the last ones."""
    ax.set_yscale("log", nonpositive="mask")
    factor, _ = common(cell_force(curve.run) for curve in curves)
    for curve in curves:
        slip, mean = curve.slip, curve.speed
        seen = slip.time >= _portrayed_from(curve.run)
        ax.plot(slip.force[seen] * factor, mean[seen], **curve.look)
        mark_early_end(ax, curve, slip.force[-1] * factor, mean[-1])


def set_limits(ax: Axes, curves: Sequence[RunCurve]) -> None:
    """Fit the axis of slip speed to the lines; say so if nothing slips."""
    if not set_speed_limits(ax, [(curve.slip, fastest_drive(curve.run)) for curve in curves]):
        say_only(ax, "no slip")


def draw_rests(ax: Axes, curves: Sequence[RunCurve]) -> None:
    """Draw the share of time at zero slip over time, a filled row for each run."""
    first = curves[0].run.samples["time"]
    end = max(float(curve.run.samples["time"][-1]) for curve in curves)
    edges = np.linspace(first[0], max(end, np.nextafter(first[0], np.inf)), IN_TIME + 1)
    for row, curve in enumerate(curves):
        share = np.diff(stuck_until(edges, curve.run.stick_intervals)) / np.diff(edges)
        fill_row(ax, row, share, edges, curve)
        ax.plot(
            KEY, [-row - 1 + 0.5 * ROW] * 2, transform=ax.get_yaxis_transform(), clip_on=False,
            **curve.look,
        )  # fmt: skip
    finish_rows(ax, len(curves))
    ax.set_ylabel("zero\nslip", rotation=0, ha="right", va="center")
    ax.set_xlabel("time $t$ (s)")
    ax.set_xlim(edges[0], edges[-1])
    name_years(ax)


def draw_held(ax: Axes, curves: Sequence[RunCurve]) -> None:
    """Draw the share of time at zero slip over the spring force, a filled row for each run."""
    forces = [cell_force(curve.run) for curve in curves]
    factor, prefix = common(forces)
    finite = np.concatenate([force[np.isfinite(force)] for force in forces]) * factor
    low, high = (finite.min(), finite.max()) if len(finite) else (0.0, 1.0)
    pad = 0.04 * (high - low) or 1.0
    edges = np.linspace(low - pad, high + pad, BY_FORCE + 1)
    for row, (curve, force) in enumerate(zip(curves, forces, strict=True)):
        times = curve.run.samples["time"]
        # however short: all are counted
        stuck = np.diff(stuck_until(times, curve.run.stick_intervals))
        total, _ = np.histogram(force[:-1] * factor, edges, weights=np.diff(times))
        held, _ = np.histogram(force[:-1] * factor, edges, weights=stuck)
        share = np.divide(held, total, out=np.zeros(BY_FORCE), where=total > 0)
        fill_row(ax, row, share, edges, curve)
    finish_rows(ax, len(curves))
    ax.set_xlabel(f"{force_symbol(curves[0].run.slider)} ({prefix}N)")
    ax.set_xlim(edges[0], edges[-1])


def fill_row(ax: Axes, row: int, share: np.ndarray, edges: np.ndarray, curve: RunCurve) -> None:
    """Fill a row, counted from the top, to the height of the share 0 to 1."""
    ax.stairs(-row - 1 + ROW * share, edges, baseline=-row - 1, fill=True, color=curve.color)


def finish_rows(ax: Axes, rows: int) -> None:
    """Rule the rows, and remove the ticks, which are meaningless there."""
    ax.set_ylim(-rows - 0.1, 0.0)
    ax.tick_params(axis="y", left=False, right=False, labelleft=False)
    for row in range(rows):
        ax.axhline(-row - 1, color=GREY, linewidth=0.3, zorder=1)
