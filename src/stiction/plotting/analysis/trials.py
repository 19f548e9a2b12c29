"""The force of a test, and of the same test after a change."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import fill
from typing import NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from numpy.typing import NDArray

from stiction.analysis.record import Record
from stiction.analysis.signals.reversals import standing_out
from stiction.analysis.signals.turning_points import COUNTS, as_counts
from stiction.plotting.page.canvas import grid_of
from stiction.plotting.page.style import BLUE, GREY, PAGE, PALE, style
from stiction.plotting.page.words import symbol
from stiction.plotting.run.lines import draw_line
from stiction.plotting.run.time_series import name_time
from stiction.text.quantity.prefix import metric_prefix
from stiction.text.sections import SYMBOL

TITLE = 48  # characters of a line above a panel
PANEL = 1.35  # height of a row, in
ACROSS = 2
ROOM = 0.4  # of the visible range, above and below it
MOST_SWINGS, LAST_SWINGS = 80, 8  # most swings in a panel, and the number shown if there are more
LEAST_SWING = 0.1  # of the force's range: smaller swings are ripple
SEEN = 0.02  # of the visible range: smaller swings are as thin as a line
LASTING = 0.5  # of the range a quarter of the time before: less dies out
# of the time shown, and of the force's range: less of the test before would mislead
WIDE, WHOLE = 0.1, 0.5
LARGE = 0.1  # of the largest force: with a smaller visible range the loading is cut off
FORCE_ROUNDING = 1e-6  # of the force: smaller variations are rounding


class Trial(NamedTuple):
    """The change in words, and the record after it."""

    title: str
    record: Record


def plot_trials(
    before: Record, trials: Sequence[Trial], axes: Sequence[Axes] | None = None
) -> NDArray[np.object_]:
    """Draw the force of each trial over the original test, a panel for each.

    Time runs as long as the trial does; where the test before is longer, it is cut, where it is
    shorter, it ends, and where next to nothing of it would be seen, or less than a swing, a band
    is the range of its force. Of a trial that goes on with more swings than a panel can show, the
    last few are drawn, and it is said of how many. Where swings that die out are too fast to be
    seen one by one, a pale band is their range, and the line their mean. The start from rest is
    shown, down to zero force, but where both come to swings that are small beside it.

    Parameters
    ----------
    before : Record
        The test before anything was changed, grey.
    trials : sequence of Trial
        At least one; blue.
    axes : Axes or sequence of Axes, optional
        Drawn on, one for each trial; by default a new figure as wide as a page.

    Returns
    -------
    ndarray of Axes
        One for each trial.

    Examples
    --------
    >>> import stiction as st
    >>> from stiction.plotting.analysis.trials import Trial
    >>> slider = st.presets.nakano_popov_2020()
    >>> turned = st.simulate(slider.replace(phi="10 deg"), "5 s", sample_rate="1 kHz")
    >>> before = st.analysis.record_of(st.simulate(slider, "5 s", sample_rate="1 kHz"))
    >>> axes = st.plotting.plot_trials(before, [Trial("10 deg", st.analysis.record_of(turned))])
    """
    across = min(ACROSS, len(trials))
    rows = -(-len(trials) // across)
    largest = [np.abs(each.force).max() for each in (before, *(trial.record for trial in trials))]
    factor, prefix = metric_prefix(np.array(largest))
    with style():
        panels = grid_of(axes, (PAGE, 0.5 + PANEL * rows), rows, across)
        drawn: dict[str, Artist] = {}
        for ax, trial in zip(panels, trials, strict=False):
            drawn |= _draw_trial(ax, before, trial, factor)
        for ax in panels[len(trials) :]:
            ax.set_axis_off()
        for ax in panels[::across]:
            ax.set_ylabel(f"spring force ({prefix}N)")
        lines = _wrap(trials[0].title).count("\n") + 1
        panels[0].legend(
            drawn.values(),
            drawn.keys(),
            loc="lower left",
            bbox_to_anchor=(0.0, 1.0),
            borderaxespad=0.5 + 1.5 * lines,  # above the title
            ncols=len(drawn),
        )
    return np.array(panels[: len(trials)], dtype=object)


def _wrap(title: str) -> str:
    """Return a title in lines, with its symbols.

    >>> _wrap("stiffness k_x = 3 MN/m")
    'stiffness $k_{x}$ = 3 MN/m'
    """
    return SYMBOL.sub(lambda found: symbol(found[0]), fill(title, TITLE))


def _draw_trial(ax: Axes, before: Record, trial: Trial, factor: float) -> dict[str, Artist]:
    """Draw one trial over the test before; return the entries of a legend."""
    title, record = trial
    low, high = later(factor, before, record)
    start, end, count = time_range(record, SEEN * (high - low) / factor)
    most = factor * max(float(np.abs(each.force).max()) for each in (before, record))
    if (
        start <= float(record.time[0]) and high - low >= LARGE * most
    ):  # the start belongs to the test: from unloaded springs
        first = factor * float(record.force[0])
        low, high = min(low, first, 0.0), max(high, first, 0.0)
    window = (end - start, high - low)
    drawn: dict[str, Artist] = {}
    force, then = factor * before.force, (before.time >= start) & (before.time <= end)
    late = force[len(force) // 2 :]
    seen = then & (force >= low) & (force <= high)
    wide = np.ptp(before.time[seen]) if seen.any() else 0.0
    if wide >= WIDE * (end - start) and np.ptp(force[seen]) >= WHOLE * np.ptp(late):
        drawn["now"] = draw_line(ax, before.time[then], force[then], GREY, 0.7, window)
    else:
        drawn["range of the force now"] = ax.axhspan(late.min(), late.max(), color=PALE, zorder=0)
    then = (record.time >= start) & (record.time <= end)
    changed = factor * record.force[then]
    drawn["changed"] = draw_line(ax, record.time[then], changed, BLUE, 1.0, window)
    ax.set(xlim=(start, end), title=_wrap(title), ylim=(low, high))
    if count:
        said = f"the last {LAST_SWINGS} of some {float(f'{count:.2g}'):.0f} swings"
        ax.text(0.03, 0.08, said, transform=ax.transAxes, fontsize=7)
    name_time(ax)
    return drawn


def time_range(record: Record, least: float) -> tuple[float, float, int]:
    """Return the time range of a panel (s), and the number of swings if only the last are shown.

    Swings smaller than `least` (N) are not seen in the panel one by one.
    """
    start, end = float(record.time[0]), float(record.time[-1])
    quarter = len(record) // 4
    before, last = record.force[-2 * quarter : -quarter], record.force[-quarter:]
    least = max(least, FORCE_ROUNDING * float(np.abs(record.force).max()))
    if quarter < 2 or np.ptp(last) <= max(least, LASTING * np.ptp(before)):
        return start, end, 0  # it dies out, or hardly moves
    height = int(LEAST_SWING * COUNTS)
    turns = len(standing_out(as_counts(last), height, height))  # two a swing
    if turns < 2:
        return start, end, 0
    period = 2.0 * (end - float(record.time[-quarter])) / turns
    count = round((end - start) / period)
    return (end - LAST_SWINGS * period, end, count) if count > MOST_SWINGS else (start, end, 0)


def later(factor: float, *records: Record) -> tuple[float, float]:
    """Return a range of force about the second halves of records, with room for their beginning."""
    halves = [factor * each.force[len(each) // 2 :] for each in records]
    low, high = min(each.min() for each in halves), max(each.max() for each in halves)
    room = ROOM * (high - low) or 0.1 * abs(high) or 1.0
    return low - room, high + room
