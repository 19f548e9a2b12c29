"""The modes of steady sliding over one parameter: growth rates and frequencies."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from stiction.arrays import Floats, xr
from stiction.linear_stability import Critical
from stiction.plotting.page.canvas import stack
from stiction.plotting.page.parameter import PLAIN, Scale, label_decades, scale_of
from stiction.plotting.page.style import BLUE, GREY, ORANGE, UNSTABLE, style

LARGE = 3000.0  # times small growth rates, the largest: a linear axis shows no crossing of these
FINEST = 1e-3  # of the largest, up to which the axis is linear then
CLOSE = 0.2  # of the axis: closer values, with their unit, would overlap


def plot_modes(
    modes: xr.Dataset, critical: Critical | None = None, axes: Sequence[Axes] | None = None
) -> NDArray[np.object_]:
    """Draw growth rates and frequencies of the modes over one parameter.

    Parameters
    ----------
    modes : Dataset
        From `stiction.linear_stability.modes_over`.
    critical : Critical, optional
        Critical values of the same parameter: dashed, with their numbers above.
    axes : sequence of Axes, optional
        Two, drawn on; by default a new figure as wide as a column.

    Returns
    -------
    ndarray of Axes
        The two.

    Examples
    --------
    >>> import stiction as st
    >>> modes = st.linear_stability.modes_over(st.presets.nakano_popov_2020(), "phi", points=11)
    >>> axes = st.plotting.plot_modes(modes)
    """
    values, log = modes["value"], modes.attrs["scale"] == "log"
    ends = values.values[[0, -1]]
    scale = scale_of(values.attrs["long_name"], values.attrs["units"], ends, logarithmic=log)
    marked = scale.in_unit(() if critical is None else critical.values)
    with style():
        above, below = stack(axes, 3.6, (1.0, 1.0))
        draw_growth_rates(above, modes, scale)
        draw_frequencies(below, modes, scale)
        for ax in (above, below):
            ax.set(xscale=modes.attrs["scale"], xlim=scale.in_unit(ends))
            for value in marked:
                ax.axvline(value, color=GREY, linewidth=0.8, dashes=(4, 2), zorder=1)
        if len(marked):
            above.plot([], [], color=GREY, linewidth=0.8, dashes=(4, 2), label="critical")
        for value, side in zip(marked, sides(above, marked), strict=True):
            named = scale.quantity(value / scale.factor)
            above.annotate(
                named if len(marked) == 1 else named.partition(" = ")[2],
                (value, 1.0),
                (0, 2),
                xycoords=("data", "axes fraction"),
                textcoords="offset points",
                ha=side,
                va="bottom",
                fontsize=7,
            )
        if log:
            below.xaxis.set_major_formatter(PLAIN)
        below.set_xlabel(scale.label)
        if any(line.get_alpha() for line in below.lines):
            above.plot([], [], color=BLUE, linewidth=3.0, alpha=0.5, label="grows")
        above.legend(loc="lower center", bbox_to_anchor=(0.5, 1.07), ncols=3)
    return np.array([above, below], dtype=object)


def sides(ax: Axes, values: Floats) -> list[str]:
    """Return the alignments of numbers above values: close neighbours lean apart.

    The axis must have its scale and limits already.
    """
    points = np.column_stack([values, np.zeros(len(values))])
    at = ax.transAxes.inverted().transform(ax.transData.transform(points))[:, 0]
    close = np.diff(at, prepend=-np.inf, append=np.inf) < CLOSE
    return [
        "right" if next_is and not last_is else "left" if last_is and not next_is else "center"
        for last_is, next_is in pairwise(close)
    ]


def draw_growth_rates(ax: Axes, modes: xr.Dataset, scale: Scale) -> None:
    """Draw growth rates, dashed where a mode does not oscillate; the unstable half is tinted.

    The axis fits the fastest growing mode; others may decay out of sight. Where these rates span
    decades it is logarithmic on either side of zero.
    """
    growth, oscillates = modes["growth_rate"].values, modes["frequency"].values > 0
    fastest = np.abs(growth.max(axis=1))
    top, least = fastest.max(), np.quantile(fastest, 0.1)
    if top > LARGE * least:
        thresh = max(least, FINEST * top)
        ax.set_yscale("symlog", linthresh=10.0 ** np.floor(np.log10(thresh)))
    highest = growth.max(axis=1)  # of the mode that decides; a slower decay is of interest, too
    bottom = max(-2.5 * top, 2.5 * min(highest.min(), -0.2 * top))
    ax.set(ylim=(bottom, 1.25 * top), ylabel="growth rate (1/s)")
    ax.axhspan(0.0, 1.25 * top, color=UNSTABLE, linewidth=0, zorder=0, label="unstable")
    ax.axhline(0.0, color=GREY, linewidth=0.6)
    at = scale.in_unit(modes["value"].values)
    for rates, rings in zip(growth.T, oscillates.T, strict=True):
        ax.plot(at, np.where(rings, rates, np.nan), color=BLUE, linewidth=1.2)
        ax.plot(at, np.where(rings, np.nan, rates), color=ORANGE, linewidth=1.2, dashes=(3, 1.5))
    ax.plot([], [], color=BLUE, linewidth=1.2, label="oscillates")
    ax.plot([], [], color=ORANGE, linewidth=1.2, dashes=(3, 1.5), label="does not")


def draw_frequencies(ax: Axes, modes: xr.Dataset, scale: Scale) -> None:
    """Draw the frequencies of the modes that oscillate, unstable ones broad.

    The axis is logarithmic where they span a decade or more.
    """
    at, frequency = scale.in_unit(modes["value"].values), modes["frequency"].values
    ax.set_ylabel("frequency (Hz)")
    ringing = frequency[frequency > 0.0]
    if not len(ringing):
        ax.set_yticks([])
        ax.text(0.5, 0.5, "no mode oscillates", transform=ax.transAxes, ha="center", va="center")
        return
    for f, rate in zip(frequency.T, modes["growth_rate"].values.T, strict=True):
        shown = np.where(f > 0, f, np.nan)
        ax.plot(at, shown, color=BLUE, linewidth=1.2)
        if (grows := rate > 0).any():
            ax.plot(at, np.where(grows, shown, np.nan), color=BLUE, linewidth=3.0, alpha=0.5)
    if ringing.max() < 10.0 * ringing.min():
        ax.set_ylim(0.0, 1.1 * ringing.max())
    else:
        ax.set_yscale("log")
        ax.yaxis.set_major_formatter(PLAIN)
        label_decades(ax.yaxis, ringing.min(), ringing.max())
