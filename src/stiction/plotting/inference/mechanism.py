"""Which mechanism a record is like: odds, how often such odds are right, and the loading."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from stiction.analysis.signals.correlated_noise import interval_95
from stiction.arrays import Floats
from stiction.plotting.page.canvas import grid_of
from stiction.plotting.page.style import BLACK, BLUE, GREY, LINES, PAGE, style
from stiction.text.quantity.wording import percent

if TYPE_CHECKING:
    from stiction.inference.mechanism.odds import Odds

LETTERS = 16  # in a line of a mechanism's name
BESIDE = 0.7  # of the range of the lines of loadings, shown above and below them
DARK = 0.5  # share above which its number is white


def plot_mechanism(odds: Odds, axes: Sequence[Axes] | None = None) -> NDArray[np.object_]:
    """Draw the odds of mechanisms beside the confusion matrix and the loading.

    Parameters
    ----------
    odds : Odds
        Of `stiction.mechanism`.
    axes : sequence of Axes, optional
        Three; by default a new figure as wide as a page.

    Returns
    -------
    ndarray of Axes
        Probabilities, and the one that a claim needs; how often simulated records of each mechanism
        (rows) are called each (columns); the loading's departure from a straight line, of the
        record and, on average, in simulations with the parameters that its features suggest; the
        band holds 95 % of those of the most probable mechanism, and ends with the panel where it
        is several times as wide as the lines differ.
    """
    with style():
        panels = grid_of(axes, (PAGE, 2.9), 1, 3, width_ratios=(1, 1.35, 1.25))
        names = [fill(name, LETTERS) for name in odds.names]
        draw_odds(panels[0], odds, names)
        draw_confusion(panels[1], odds.confusion, names)
        draw_loading(panels[2], odds)
    return np.array(panels, dtype=object)


def draw_odds(ax: Axes, odds: Odds, names: Sequence[str]) -> None:
    """Draw the probability of each mechanism that the record is like, and the one a claim needs."""
    places = np.arange(len(names))
    claimed = None if odds.objections() else odds.likeliest
    colors = [BLUE if place == claimed else GREY for place in range(len(names))]
    unlike = [its.unlike for its in odds.likeness]  # whose probability means nothing
    ax.barh(places, np.where(unlike, 0.0, odds.probabilities), color=colors, height=0.6)
    for place in places[unlike]:
        ax.text(0.02, place, "unlike this record", va="center", fontsize=6.5)
    ax.axvline(odds.needed, color=BLACK, linewidth=0.8, linestyle=(0, (4, 2)))
    ax.set_yticks(places, names)
    ax.invert_yaxis()
    ax.tick_params(axis="y", length=0.0)
    ax.set(xlim=(0.0, 1.0), xlabel="probability", title="this record")


def draw_confusion(ax: Axes, confusion: Floats, names: Sequence[str]) -> None:
    """Draw the confusion matrix, each share written in its cell."""
    ax.imshow(confusion, cmap="Blues", vmin=0.0, vmax=1.0, aspect="auto")
    for (row, column), share in np.ndenumerate(confusion):
        color = "white" if share > DARK else BLACK
        ax.text(column, row, percent(share), ha="center", va="center", color=color, fontsize=7.0)
    columns = [*names, "undecided"]
    ax.set_xticks(range(len(columns)), columns, rotation=45.0, ha="right", rotation_mode="anchor")
    ax.set_yticks(range(len(names)), [""] * len(names))
    ax.tick_params(length=0.0, which="both")
    ax.set_title("simulated records (rows) called so")


def draw_loading(ax: Axes, odds: Odds) -> None:
    """Draw the bend of the record's loading over the simulated ones."""
    share = odds.shares
    parts = len(share)  # of the first record, where there are several
    for i, (name, its) in enumerate(zip(odds.names, odds.likeness, strict=True)):
        color, line = LINES[i % len(LINES)]
        bends = 100.0 * its.bends[:, :parts]
        ax.plot(share, bends.mean(axis=0), color=color, linestyle=line, label=name)
        if i == odds.likeliest:
            low, high = interval_95(bends)
            said = "95 % of its simulations"
            ax.fill_between(share, low, high, color=color, alpha=0.2, linewidth=0.0, label=said)
    record = 100.0 * odds.bend[:parts]
    ax.plot(share, record, "o-", color=BLACK, markersize=2.0, linewidth=0.5, label="this record")
    ax.axhline(0.0, color=GREY, linewidth=0.5, zorder=0)
    lines = np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in ax.lines])
    beside = BESIDE * np.ptp(lines)  # a band that is wider would hide how the lines differ
    if beside > 0.0:
        bottom, top = ax.get_ylim()
        ax.set_ylim(max(bottom, lines.min() - beside), min(top, lines.max() + beside))
    ax.set(xlabel="share of the loading time", title="bend of loading (% of rise)")
    ax.legend(loc="upper center", bbox_to_anchor=(0.42, -0.22), fontsize=6.5)
