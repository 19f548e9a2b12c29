"""A record with its cycles marked, and its kind of motion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.markers import CARETDOWN, CARETUP
from numpy.typing import ArrayLike, NDArray

from stiction.analysis.measurement.run_record import as_record
from stiction.analysis.motion.changes.mean_load import under_mean_load
from stiction.analysis.motion.regime.classify import classify_record
from stiction.analysis.record import Record
from stiction.analysis.signals.robust import without_outliers
from stiction.analysis.signals.turning_points import without_spikes
from stiction.arrays import Floats, xr
from stiction.errors import ResultError
from stiction.plotting.page.canvas import grid_of
from stiction.plotting.page.style import BLUE, GREY, ORANGE, PAGE, PALE, RED, style
from stiction.plotting.run.lines import draw_line
from stiction.plotting.run.time_series import name_time
from stiction.text.quantity.prefix import metric_prefix
from stiction.trajectory import Trajectory

FEW_CYCLES = 12  # cycles that can be distinguished on a page's width
SHOWN_CYCLES = 6  # cycles in the close-up
NOISE = 0.05  # of the panel: a band so low is that of noise, and its edges would seem two forces
CLEAR = 0.5  # of the usual drop, by which a peak before the first cycle is one
SPAN, MARGIN = 2.0, 0.08  # wild samples may take as much room as the others; above and below them


def plot_cycles(
    source: Trajectory | Record, axes: Axes | Sequence[Axes] | None = None
) -> NDArray[np.object_]:
    """Draw the force of a record with its peaks and troughs marked, and its kind of motion.

    If there are many cycles, some from the middle of the record are magnified below.

    Parameters
    ----------
    source : Record or Trajectory
        Measured, or a run; not empty.
    axes : Axes or sequence of Axes, optional
        For the whole record, and for the part that is shown larger; by default a new figure as wide
        as a page.

    Returns
    -------
    ndarray of Axes
        One, or two where there are many cycles.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "5 s", sample_rate="1 kHz")
    >>> axes = st.plotting.plot_cycles(run)
    """
    record = as_record(source)
    _, found, regime = classify_record(record)
    return plot_motion(record, found.cycles, regime.kind, axes)


def plot_motion(
    record: Record, cycles: xr.Dataset, kind: str, axes: Axes | Sequence[Axes] | None = None
) -> NDArray[np.object_]:
    """Draw as `plot_cycles` does, with cycles and kind of motion already known."""
    if not len(record):
        raise ResultError("the record has no samples; there is nothing to draw")
    steady = under_mean_load(record)
    many = cycles.sizes["cycle"] > FEW_CYCLES
    with style():
        panels = grid_of(axes, (PAGE, 4.4 if many else 2.6), 2 if many else 1, 1)
        draw_cycles(panels[0], steady, cycles, first_peak(steady, cycles))
        panels[0].set_title(kind.capitalize())
        if steady is not record:
            _draw_as_measured(panels[0], record)
        if many and len(panels) > 1:
            _zoom(panels[0], panels[1], steady, cycles)
        for ax in panels:
            name_time(ax)
    return np.array(panels, dtype=object)


def first_peak(record: Record, cycles: xr.Dataset) -> tuple[Floats, Floats]:
    """Return time and force of the peak before the first cycle, a value each; none if unclear.

    It ends a first loading, or a cycle that the beginning of the record cuts.
    """
    before = int(np.searchsorted(record.time, cycles["start"].values[:1].sum()))
    force = without_spikes(record.force[:before])
    if not before:
        return force, force
    at = int(np.argmax(force))
    least = CLEAR * float(np.median(cycles["drop"].values))
    fallen = float(force[at]) - float(cycles["start_force"].values[0])
    if not (at and fallen >= least and force[at] - force[:at].min() >= least):
        return force[:0], force[:0]
    return record.time[[at]], force[[at]]


def draw_cycles(
    ax: Axes,
    record: Record,
    cycles: xr.Dataset,
    first: tuple[ArrayLike, ArrayLike] = ((), ()),
) -> None:
    """Draw the force of a record over time and mark peaks and troughs.

    `first` are times, s, and forces, N, of peaks before the first cycle.
    """
    factor, prefix = metric_prefix(record.force)
    draw_line(ax, record.time, factor * record.force, GREY, 0.5, thin=NOISE)
    size = float(np.clip(60.0 / max(cycles.sizes["cycle"], 1), 1.5, 4.0))  # pt: they must not touch
    low_time = np.append(cycles["start"].values[:1], cycles["trough_time"].values)
    low = np.append(cycles["start_force"].values[:1], cycles["trough"].values)
    high_time = np.append(first[0], cycles["peak_time"].values)
    high = np.append(first[1], cycles["peak"].values)
    for time, force, color, marker, name in (
        # the tips are at the force, so that a small drop shows between two rows of markers
        (high_time, high, RED, CARETDOWN, "peak"),
        (low_time, low, BLUE, CARETUP, "trough"),
    ):
        if len(time):
            (marks,) = ax.plot(time, factor * force, color=color, markersize=size, label=name)
            marks.set(marker=marker, linestyle="none")
    if cycles.sizes["cycle"]:
        _name_lines(ax, markerscale=4.0 / size)
    ax.margins(y=MARGIN)
    _leave_out_wild(ax, factor * record.force)
    ax.set_ylabel(f"spring force ({prefix}N)")


def _name_lines(ax: Axes, markerscale: float = 1.0) -> None:
    """Add a legend above the panel, where it hides no trough."""
    ax.legend(
        loc="lower right",
        bbox_to_anchor=(1.0, 1.0),
        borderaxespad=0.2,
        ncols=4,
        markerscale=markerscale,
    )


def _draw_as_measured(ax: Axes, record: Record) -> None:
    """Draw the force as it was measured behind that under the mean load, and name both."""
    factor, _ = metric_prefix(record.force)
    ax.lines[0].set_label("under the mean load")
    measured = draw_line(ax, record.time, factor * record.force, ORANGE, 0.5)
    measured.set(label="as measured", zorder=0.5)
    _name_lines(ax)


def _leave_out_wild(ax: Axes, force: Floats) -> None:
    """Frame a force (as drawn) without its wild samples, if these would flatten it; say so."""
    rest = without_outliers(force)
    low, high = float(rest.min()), float(rest.max())
    if np.ptp(force) <= SPAN * (high - low):
        return
    room = MARGIN * (high - low)
    ax.set_ylim(low - room, high + room)
    beyond = int(np.count_nonzero((force < low) | (force > high)))
    said = f"{beyond} sample{'s' * (beyond > 1)} beyond the axis"
    ax.text(0.5, 1.02, said, transform=ax.transAxes, ha="center", color=GREY)  # above all lines


def _zoom(whole: Axes, part: Axes, record: Record, cycles: xr.Dataset) -> None:
    """Show some cycles from the middle on `part`, and shade that time on `whole`."""
    first = (cycles.sizes["cycle"] - SHOWN_CYCLES) // 2
    last = first + SHOWN_CYCLES - 1
    begin, end = cycles["start"].values[first], cycles["trough_time"].values[last]
    margin = 0.1 * (end - begin)
    begin, end = begin - margin, end + margin
    seen = (record.time >= begin) & (record.time <= end)
    chosen = cycles.isel(cycle=slice(max(first - 1, 0), last + 2))  # cut ones as well
    near = record.model_copy(update={"time": record.time[seen], "force": record.force[seen]})
    draw_cycles(part, near, chosen)
    if (legend := part.get_legend()) is not None:
        legend.remove()  # it would hide the magnified cycles
    part.set(title="Shaded above", xlim=(begin, end))
    whole.axvspan(begin, end, color=PALE, zorder=0)
