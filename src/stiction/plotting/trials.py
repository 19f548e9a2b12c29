"""The force of a test, and of the same test after a change."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from stiction.analysis.record import Record
from stiction.plotting.canvas import canvas, fixed, listed
from stiction.plotting.style import BLUE, GREY, PAGE, style
from stiction.plotting.time_series import draw_line, name_time, prefixed

PANEL = 1.35  # height of a row, in
ACROSS = 2
ROOM = 0.4  # of what is shown, above and below it


class Trial(NamedTuple):
    """What was changed, in words, and what was recorded then."""

    title: str
    record: Record


def plot_trials(
    before: Record, trials: Sequence[Trial], axes: Sequence[Axes] | None = None
) -> NDArray[np.object_]:
    """Draw the force of each trial over that of the test before, a panel a trial.

    Time runs as long as the trial does; where the test before is longer, it is cut, where it is
    shorter, it ends. Forces are shown about what both come to, the loading from nothing is cut
    off: an oscillation may be small beside it.

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
    factor, prefix = prefixed(np.array(largest))
    with style():
        if axes is None:
            fig = canvas(PAGE, 0.5 + PANEL * rows)
            panels = fixed(list(fig.subplots(rows, ACROSS, squeeze=False).ravel()))
        else:
            panels = listed(axes)
        for ax, (title, record) in zip(panels, trials, strict=False):
            start, end = record.time[0], record.time[-1]
            seen = (before.time >= start) & (before.time <= end)
            line = draw_line(ax, before.time[seen], factor * before.force[seen], GREY, 0.7)
            line.set_label("now")
            line = draw_line(ax, record.time, factor * record.force, BLUE, 1.0)
            line.set_label("changed")
            ax.set(xlim=(start, end), title=title, ylim=later(factor, before, record))
            name_time(ax)
        for ax in panels[len(trials) :]:
            ax.set_axis_off()
        for ax in panels[::ACROSS]:
            ax.set_ylabel(f"spring force ({prefix}N)")
        panels[0].legend(loc="upper right", ncols=2)
    return np.array(panels[: len(trials)], dtype=object)


def later(factor: float, *records: Record) -> tuple[float, float]:
    """Return a range of force about the second halves of records, with room for their beginning."""
    halves = [factor * each.force[len(each) // 2 :] for each in records]
    low, high = min(each.min() for each in halves), max(each.max() for each in halves)
    room = ROOM * (high - low) or 0.1 * abs(high) or 1.0
    return low - room, high + room
