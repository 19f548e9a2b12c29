"""Maps of a study: kinds of motion and measures over the plane of two parameters, and slices."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from stiction.arrays import Floats
from stiction.plotting.page.parameter import Scale, sparse
from stiction.plotting.page.style import BLACK, BLUE, GREEN
from stiction.plotting.shades import (
    COLORS,
    MARKERS,
    NO_RESULT,
    NO_VALUE,
    kind_codes,
    kind_shades,
    legend_of,
    measure_shades,
    present_kinds,
)

CASING = [patheffects.withStroke(linewidth=3.0, foreground="white")]
PLAINLY = 1e3  # a smaller factor is written without powers of ten


class Side(NamedTuple):
    """One side of a map: its scale, its values as drawn, and whether it is logarithmic."""

    scale: Scale
    values: Floats
    log: bool

    @property
    def edges(self) -> Floats:
        """Borders of the cells around the values."""
        at = np.log(self.values) if self.log else self.values
        if len(at) == 1:
            half = np.array([-0.5, 0.5]) * (1.0 if self.log or at[0] == 0.0 else abs(at[0]))
            found = at[0] + half
        else:
            middle = 0.5 * (at[1:] + at[:-1])
            found = np.concatenate([at[:1], middle, at[-1:]])
        return np.asarray(np.exp(found) if self.log else found)


def draw_regimes(ax: Axes, x: Side, y: Side, kinds: NDArray[np.object_]) -> list[Patch]:
    """Draw the kind of motion of each run; return a patch per kind for the legend.

    The kinds (n, m) are named as in `COLORS`; others (a run that failed, or is not done) are
    hatched.
    """
    shades, codes = kind_shades(), kind_codes(kinds)
    ax.set_facecolor("white")
    failed = np.isnan(codes)
    if failed.any():
        ax.patch.set(hatch="xxxx", edgecolor="#777777")
    ax.pcolormesh(
        x.edges, y.edges, np.ma.masked_invalid(codes.T), cmap=shades.colormap, norm=shades.norm,
        rasterized=True,
    )  # fmt: skip
    _frame(ax, x, y)
    patches = [
        Patch(facecolor=COLORS[name], edgecolor=BLACK, linewidth=0.4, label=legend_of(name))
        for name in present_kinds(kinds)
    ]
    if failed.any():
        patches.append(Patch(facecolor="white", edgecolor="#777777", hatch="xxxx", label=NO_RESULT))
    return patches


def draw_measure(
    ax: Axes, x: Side, y: Side, values: Floats, label: str
) -> tuple[QuadMesh, list[Patch]]:
    """Draw a measure as a heat map, logarithmic over many decades, with a colour bar.

    Parameters are those of `draw_regimes`, and the name of the measure; where there is no value it
    is hatched. Returned is what is coloured, and a patch for the legend if some of it is hatched.
    """
    shades = measure_shades(values)
    hatched = []
    if not np.isfinite(values).all():
        ax.patch.set(hatch="////", edgecolor="#BBBBBB")
        hatched = [Patch(facecolor="white", edgecolor="#BBBBBB", hatch="////", label=NO_VALUE)]
    mesh = ax.pcolormesh(
        x.edges, y.edges, np.ma.masked_invalid(values.T), cmap=shades.colormap, norm=shades.norm,
        rasterized=True,
    )  # fmt: skip
    _frame(ax, x, y)
    low, high = shades.limits
    beyond = "min" if (values < low).any() else "neither"
    bar = ax.figure.colorbar(mesh, ax=ax, label=label, pad=0.02, extend=beyond)
    if shades.log and high < PLAINLY * low:
        for formatted in (bar.ax.yaxis.set_major_formatter, bar.ax.yaxis.set_minor_formatter):
            formatted(sparse(low))
    return mesh, hatched


def draw_theory(ax: Axes, x: Side, y: Side, fields: Mapping[str, Floats]) -> list[Line2D]:
    """Draw the zero contour of each field; return the lines of fields that have one.

    `fields` are arrays (n, m) by the names of their lines, as fine as the lines are to be.
    """
    lines = []
    looks: tuple[tuple[str, Any], ...] = ((BLACK, "-"), (GREEN, (0, (4, 1.5))))
    for (name, field), (color, dash) in zip(fields.items(), looks, strict=False):
        found = np.ma.masked_invalid(field.T)
        if found.count() and found.min() < 0.0 < found.max():
            lined = ax.contour(
                x.values, y.values, found, [0.0], colors=[color], linewidths=1.6, linestyles=[dash]
            )
            lined.set(path_effects=CASING)
            lines.append(Line2D([], [], color=color, linewidth=1.6, linestyle=dash, label=name))
    return lines


def draw_changes(
    ax: Axes, x: Side, y: Side, low: tuple[Side, Side], high: tuple[Side, Side]
) -> list[Line2D]:
    """Draw a point at each refined change of motion; return the handles of the legend.

    A line joins the ends of its interval, `low` and `high`, which failed runs may leave wide.
    """
    ends = ([begin.values, end.values] for begin, end in zip(low, high, strict=True))
    ax.plot(*ends, "-", color=BLACK, linewidth=1.0, path_effects=CASING, zorder=4)
    return ax.plot(
        x.values, y.values, "o", color=BLACK, markersize=2.4, markeredgecolor="white",
        markeredgewidth=0.5, label="change, refined", zorder=5,
    )  # fmt: skip


def draw_slice(
    ax: Axes, x: Side, values: Floats, label: str, kinds: Sequence[str] = ()
) -> list[Line2D]:
    """Draw a measure over one parameter, a point for each run; return the handles of the legend.

    A point has the colour and the marker of its run's kind of motion, if these are given.
    """
    ax.plot(x.values, values, "-", color=BLUE, linewidth=0.8)
    handles: list[Line2D] = []
    if not kinds:
        ax.plot(x.values, values, "o", color=BLUE, markersize=2.5)
    for name in present_kinds(np.array(kinds, dtype=object)):
        here = np.array([kind == name for kind in kinds]) & np.isfinite(values)
        if here.any():
            handles += ax.plot(
                x.values[here], values[here], MARKERS[name], color=COLORS[name], markersize=4.5,
                markeredgecolor=BLACK, markeredgewidth=0.5, linestyle="none", label=legend_of(name),
                zorder=3,
            )  # fmt: skip
    ax.update_datalim([(each, 0.0) for each in x.values], updatey=False)  # runs without a value too
    ax.autoscale_view()
    _label_axis(ax, x, "x")
    ax.set_ylabel(label)
    return handles


def draw_critical(ax: Axes, x: Side) -> list[Line2D]:
    """Draw the values at which steady sliding loses or gains stability; return the handle."""
    lines = [ax.axvline(each, color=BLACK, linewidth=1.0, linestyle="--") for each in x.values]
    if lines:
        its = ", ".join(f"{each:.4g}" for each in x.values)
        unit = "" if x.scale.unit == "1" else f" {x.scale.unit}"
        label = f"steady sliding changes its stability: {its}{unit}"
        lines[0].set_label(label)
    return lines[:1]


def draw_kinds(ax: Axes, x: Side, kinds: Sequence[str]) -> None:
    """Draw the kind of motion over one parameter: a row for each kind, in the order of `COLORS`.

    Other kinds (a run that failed, or is not done) have no result.
    """
    names = [name if name in COLORS else NO_RESULT for name in kinds]
    rows = [name for name in (*COLORS, NO_RESULT) if name in names]
    for row, name in enumerate(rows):
        here = np.array([each == name for each in names])
        ax.plot(
            x.values[here], np.full(here.sum(), row), MARKERS.get(name, "x"), markersize=5.0,
            markeredgewidth=0.4, markeredgecolor=BLACK, color=COLORS.get(name, "white"),
        )  # fmt: skip
    _label_axis(ax, x, "x")
    words = [legend_of(name) for name in rows]
    ax.set(yticks=range(len(rows)), yticklabels=words, ylim=(len(rows) - 0.5, -0.5))
    ax.tick_params(axis="y", which="both", length=0.0)


def draw_points(ax: Axes, x: Floats, y: Floats, kinds: Sequence[str]) -> list[Line2D]:
    """Draw a point for each run, coloured by its kind of motion; return a marker per kind."""
    made = []
    for name, color in COLORS.items():
        here = np.array([kind == name for kind in kinds])
        if here.any():
            look = {"marker": "o", "linestyle": "none", "markeredgecolor": BLACK}
            size = {"markersize": 3.2, "markeredgewidth": 0.3, "color": color}
            made += ax.plot(x[here], y[here], **look, **size, label=legend_of(name), zorder=4)  # type: ignore[arg-type]
    return made


def _frame(ax: Axes, x: Side, y: Side) -> None:
    for side, way in ((x, "x"), (y, "y")):
        _label_axis(ax, side, way)
        ax.set(**{f"{way}lim": (side.edges.min(), side.edges.max())})
    ax.tick_params(which="both", direction="out", top=False, right=False)


def _label_axis(ax: Axes, side: Side, way: str) -> None:
    ax.set(**{f"{way}scale": "log" if side.log else "linear", f"{way}label": side.scale.label})
    if side.log and side.values.max() < PLAINLY * side.values.min():
        axis, labels = getattr(ax, f"{way}axis"), sparse(side.values.min())
        axis.set_major_formatter(labels)
        axis.set_minor_formatter(labels)
