"""The force of a test, and of the same test after a change."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from stiction.analysis.record import Record
from stiction.analysis.signals.reversals import standing_out
from stiction.analysis.signals.turning_points import FINE, as_counts
from stiction.plotting.page.canvas import as_list, canvas, fix_ticks
from stiction.plotting.page.style import BLUE, GREY, PAGE, style
from stiction.plotting.run.time_series import draw_line, name_time
from stiction.text.quantity_text import metric_prefix

PANEL = 1.35  # height of a row, in
ACROSS = 2
ROOM = 0.4  # of the visible range, above and below it
MOST, FEW = 40, 8  # most swings in a panel, and the number shown if there are more
LEAST = 0.1  # of the visible range: smaller swings cannot be seen
ROUNDING = 1e-6  # of the force: smaller variations are rounding


class Trial(NamedTuple):
    """The change in words, and the record after it."""

    title: str
    record: Record


def plot_trials(
    before: Record, trials: Sequence[Trial], axes: Sequence[Axes] | None = None
) -> NDArray[np.object_]:
    """Draw the force of each trial over that of the original test, a panel for each.

    Time runs as long as the trial does; where the test before is longer, it is cut, where it is
    shorter, it ends. Of a trial with more swings than a panel can show, the last few are drawn,
    and it is said of how many. Forces are shown about what both come to, the loading from nothing
    is cut off: an oscillation may be small beside it.

    Parameters
    ----------
    before : Record
        The test before anything was changed, grey.
    trials : sequence of Trial
        At least one; blue.
    axes : Axes, one for each trial, optional
        Drawn on; a new figure as wide as a page when left out.

    Returns
    -------
    ndarray of Axes
        One for each trial.
    """
    rows = -(-len(trials) // ACROSS)
    largest = [np.abs(each.force).max() for each in (before, *(trial.record for trial in trials))]
    factor, prefix = metric_prefix(np.array(largest))
    with style():
        if axes is None:
            fig = canvas(PAGE, 0.5 + PANEL * rows)
            panels = fix_ticks(list(fig.subplots(rows, ACROSS, squeeze=False).ravel()))
        else:
            panels = as_list(axes)
        for ax, (title, record) in zip(panels, trials, strict=False):
            start, end, count = time_range(before, record)
            for each, label, color, width in (
                (before, "now", GREY, 0.7),
                (record, "changed", BLUE, 1.0),
            ):
                seen = (each.time >= start) & (each.time <= end)
                if seen.any():
                    line = draw_line(ax, each.time[seen], factor * each.force[seen], color, width)
                    line.set_label(label)
            ax.set(xlim=(start, end), title=title, ylim=later(factor, before, record))
            if count > MOST:
                said = f"{FEW} of some {float(f'{count:.2g}'):.0f} swings"
                ax.text(0.02, 0.04, said, transform=ax.transAxes, fontsize=7)
            name_time(ax)
        for ax in panels[len(trials) :]:
            ax.set_axis_off()
        for ax in panels[::ACROSS]:
            ax.set_ylabel(f"spring force ({prefix}N)")
        panels[0].legend(loc="upper right", ncols=2)
    return np.array(panels[: len(trials)], dtype=object)


def time_range(before: Record, record: Record) -> tuple[float, float, int]:
    """Return the time range of a panel (s), and the approximate number of swings.

    If both motions last into its later half, the range ends with the first of them.
    """
    start, end, half = float(record.time[0]), float(record.time[-1]), len(record) // 2
    late = record.force[half:]
    span = max(float(np.ptp(each.force[len(each) // 2 :])) for each in (before, record))
    height = LEAST * max(span, ROUNDING * float(np.abs(late).max()))
    if not np.ptp(late) > height:
        return start, end, 0
    least = int(height / np.ptp(late) * FINE)
    count = len(standing_out(as_counts(late), least, least))  # half of the time, two turns a swing
    if count <= MOST:
        return start, end, count
    period = 2.0 * (end - float(record.time[half])) / count
    last = float(before.time[-1])
    end = min(end, last) if last > record.time[half] else end
    return end - FEW * period, end, count


def later(factor: float, *records: Record) -> tuple[float, float]:
    """Return a range of force about the second halves of records, with room for their beginning."""
    halves = [factor * each.force[len(each) // 2 :] for each in records]
    low, high = min(each.min() for each in halves), max(each.max() for each in halves)
    room = ROOM * (high - low) or 0.1 * abs(high) or 1.0
    return low - room, high + room
