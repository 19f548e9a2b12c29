"""The expected width of a parameter after further tests."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from stiction.plotting.page.canvas import grid_of
from stiction.plotting.page.style import BLACK, BLUE, GREY, style

if TYPE_CHECKING:
    from stiction.inference.next_test.advice import Advice

NAMES = ("ratio", "low", "high")
WIDTH = 4.5  # inches: long names stand beside the axis
ROW = 0.22  # inches for a test


def plot_design(advice: Advice, ax: Axes | None = None) -> Axes:
    """Draw the expected width of the posterior of the parameter of interest, test by test.

    Parameters
    ----------
    advice : Advice
        Of `stiction.design`.
    ax : Axes, optional
        Drawn on; by default a new figure.

    Returns
    -------
    Axes
        The width over that from the present test, with 95 % intervals; the best test on top.
    """
    i, tests = advice.index, advice.ranked
    with style():
        (ax,) = grid_of(ax, (WIDTH, ROW * len(tests) + 0.7), 1, 1)
        places = np.arange(len(tests))[::-1]
        ratio, low, high = (np.array([getattr(t, n)[i] for t in tests]) for n in NAMES)
        ax.errorbar(
            ratio, places, xerr=[ratio - low, high - ratio], fmt="o", color=BLUE,
            ecolor=GREY, markersize=3.5, elinewidth=1.0,
        )  # fmt: skip
        ax.axvline(1.0, color=BLACK, linewidth=0.8, linestyle=(0, (4, 2)))
        ax.set_yticks(places, [test.test for test in tests])
        ax.set(
            xlim=(0.0, max(1.1, 1.05 * float(high.max()))), ylim=(-0.7, len(tests) - 0.3),
            xlabel=f"uncertainty of {advice.of}\n(after the present test: 1)",
        )  # fmt: skip
    return ax
