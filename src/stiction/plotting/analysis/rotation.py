"""The friction force in the plane: along the drive against across it, while the spring is loaded.

A force that turns runs along an arc about zero; that of a mass at rest along a straight line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap, Normalize

from stiction.analysis.rotation.findings import TURNING, Rotation
from stiction.analysis.rotation.loading import MeanLoading, loadings
from stiction.analysis.rotation.path import arc_path, best_arc
from stiction.analysis.rotation.plane import with_both_forces
from stiction.analysis.signals.straight_line import line
from stiction.arrays import Floats
from stiction.errors import ResultError
from stiction.plotting.page.canvas import panel
from stiction.plotting.page.style import BLACK, RED, SKY, style
from stiction.text.quantity.prefix import metric_prefix
from stiction.text.quantity.wording import in_words

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis

PARTS_OF_LOADING = 80  # of a loading: means over them leave noise and fast oscillation out
ALIGNED = 1e-3  # across over along: less is not seen beside the width of a line
CLOSE = 0.25  # of an arrow: across, names in the middles of two that are so close would overlap
MOST_LOADINGS = 40  # drawn, evenly chosen from more
# yellow, at the upper end of the map, is too pale on white
TIMES = ListedColormap(colormaps["viridis"](np.linspace(0.0, 0.85, 256)), "times")


def plot_rotation(found: Analysis, ax: Axes | None = None) -> Axes:
    """Draw the force in the plane in each loading, and the arc and straight line that describe it.

    A loading is a thin line whose colour is its time. The arc is about the zero that the
    legend names, over the range of the mean loading. Arrows are the mean force at its beginning
    and before slip, where the zero of the force across is known.

    Parameters
    ----------
    found : Analysis
        Of a run, or of a record with both forces.
    ax : Axes, optional
        Drawn on; by default a new figure as wide as a column.

    Raises
    ------
    ResultError
        If the analysis does not know how the force changes: `Analysis.missing` says why. If the
        force has no part across, as of an aligned rig.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "5 s", sample_rate="2 kHz")
    >>> ax = st.plotting.plot_rotation(st.analyse(run))
    """
    its: Rotation | None = found.parts["rotation"]
    record = with_both_forces(found.source, found.record)
    if its is None or record is None:
        why = found.missing.get("rotation", "the record has no force across")
        raise ResultError(f"there is no rotation of the force to draw: {why}")
    if is_along_drive(its):
        raise ResultError("there is no rotation of the force to draw: it has no part across")
    forces = np.stack([record.force, np.asarray(record.force_across)])
    mean = loadings(record.time, forces, found.cycles).mean()
    zero = its.zero if its.kind == TURNING else 0.0
    factor, prefix = metric_prefix(mean.x)
    with style():
        ax = panel(ax, 3.3)
        own = ax.get_figure() is not None and len(ax.figure.axes) == 1
        begins, paths = _paths(record.time, forces, found)
        paths = [factor * (path - (0.0, zero)) for path in paths]
        lines = LineCollection(paths, cmap=TIMES, linewidths=0.7, zorder=2, label="each loading")
        lines.set_norm(Normalize(float(begins.min()), float(begins.max()) or 1.0))
        lines.set_array(begins)
        ax.add_collection(lines, autolim=True)
        _draw_rivals(ax, its, mean, factor, zero)
        known = its.stated or its.kind == TURNING
        if known:
            _draw_arrows(ax, mean, factor, zero)
        ax.set_aspect("equal", adjustable="datalim")
        ax.margins(0.08)
        ax.autoscale_view()
        ax.set_xlabel(f"force along ({prefix}N)")
        ax.set_ylabel(f"force across{', from its zero' if known else ''} ({prefix}N)")
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0))
        if own and len(begins) > 1:
            ax.figure.colorbar(
                ScalarMappable(lines.norm, TIMES), ax=ax, label="time of the loading (s)", pad=0.02
            )
    return ax


def is_along_drive(its: Rotation) -> bool:
    """Return whether the force of a rig, such as an aligned one, has no part across."""
    return its.stated and bool(np.abs(its.across).max() < ALIGNED * np.abs(its.along).max())


def _paths(time: Floats, forces: Floats, found: Analysis) -> tuple[Floats, list[Floats]]:
    """Return the beginning of each loading, s, and its path, (n, 2), N, of means over its parts."""
    starts, ends = (found.cycles[name].values for name in ("start", "peak_time"))
    chosen = np.unique(np.linspace(0, len(starts) - 1, MOST_LOADINGS).astype(int))
    paths = []
    for begin, end in zip(starts[chosen], ends[chosen], strict=True):
        first, last = np.searchsorted(time, (begin, end))
        parts = np.array_split(
            forces[:, first : last + 1], min(PARTS_OF_LOADING, last + 1 - first), axis=1
        )
        paths.append(np.array([part.mean(axis=1) for part in parts]))
    return starts[chosen], paths


def _draw_rivals(ax: Axes, its: Rotation, mean: MeanLoading, factor: float, zero: float) -> None:
    """Draw the best arc and the best straight line, where the loadings are.

    Where the force turns, the arc has the radius F_0, of which the report tells. Elsewhere it is
    the path that was fitted, which the straight line was compared with.
    """
    known = its.zero_error if its.stated else 0.0
    arc = best_arc(mean, known)
    about = f"{'stated' if its.stated else 'fitted'} zero"
    if not its.stated and its.kind != TURNING:  # which no axis shows
        about += f", {in_words(arc.zero, 'N', 2)}"
    along, across = arc_path(mean, arc, known, even=its.kind == TURNING).T
    ax.plot(
        factor * along, factor * (across - zero),
        color=SKY, linewidth=3.0, zorder=1, label=f"best arc ({about}): turning",
    )  # fmt: skip
    straight = line(mean.x, mean.y)
    x = mean.x[[0, -1]] + np.array([-0.1, 0.1]) * np.ptp(mean.x)
    ax.plot(
        factor * x, factor * (straight.at(x) - zero), color=RED, zorder=3, linewidth=1.3,
        linestyle=(0, (4, 2)), label="best line: growing",
    )  # fmt: skip


def _draw_arrows(ax: Axes, mean: MeanLoading, factor: float, zero: float) -> None:
    """Draw the mean force early and late in the loadings, as arrows from zero."""
    ends = factor * np.array([mean.x[[0, -1]], mean.y[[0, -1]] - zero]).T
    across = np.abs(np.diff(ends[:, 1]))[0]
    close = across < CLOSE * np.abs(ends).max()  # a name is wider than it is high
    for end, name, below in zip(ends, ("early", "before slip"), (False, True), strict=True):
        arrow = {"arrowstyle": "-|>", "color": BLACK, "lw": 0.9, "shrinkA": 0, "shrinkB": 0}
        ax.annotate("", end, (0.0, 0.0), arrowprops=arrow, zorder=4)
        if close:
            at, offset, side = end, (0.0, -7.0 if below else 7.0), "top" if below else "bottom"
        else:
            at, offset, side = 0.5 * end, (0.0, 0.0), "center"
        ax.annotate(
            name, at, offset, textcoords="offset points", va=side, fontsize=7, zorder=5,
            ha="right" if close and below else "center",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
        )  # fmt: skip
    ax.plot(0.0, 0.0, "o", color=BLACK, markersize=2.5)
