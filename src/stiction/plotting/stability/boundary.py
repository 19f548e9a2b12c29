"""The examination of steady sliding, and its boundary in the plane of two parameters."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray

from stiction.arrays import Floats, xr
from stiction.linear_stability import Stability
from stiction.plotting.page.canvas import as_list, panel
from stiction.plotting.page.parameter import PLAIN, Scale, scale_of
from stiction.plotting.page.style import BLACK, BLUE, UNSTABLE, style
from stiction.plotting.stability.modes import plot_modes

PIXELS = 161  # in each direction, of the signed distance to the boundary


def plot_boundary(
    curve: xr.Dataset,
    closed_form: tuple[ArrayLike, ArrayLike] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw the boundary of stability in two parameters, with the slider's own point.

    Parameters
    ----------
    curve : Dataset
        From `stiction.linear_stability.boundary`.
    closed_form : tuple of array, optional
        Another boundary to compare with, the two parameters in SI.
    ax : Axes, optional
        Drawn on; by default a new figure as wide as a column.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> curve = st.linear_stability.boundary(slider, "phi", "drive.velocity")
    >>> ax = st.plotting.plot_boundary(curve)
    """
    with style():
        ax = panel(ax, 2.9)
        x, y = draw_boundary(ax, curve)
        if closed_form is not None:
            ax.plot(
                x.in_unit(closed_form[0]), y.in_unit(closed_form[1]), color=BLACK, linewidth=1.1,
                dashes=(1.2, 1.8), dash_capstyle="round", label="closed form", zorder=4,
            )  # fmt: skip
        ax.plot(
            x.in_unit(curve.attrs["x_own"]), y.in_unit(curve.attrs["y_own"]), color=BLACK,
            marker="o", markersize=4.5, linestyle="none", label="this slider", zorder=5,
            clip_on=False,
        )  # fmt: skip
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3)
    return ax


def draw_boundary(ax: Axes, curve: xr.Dataset) -> tuple[Scale, Scale]:
    """Draw the boundary from `stiction.linear_stability.boundary`; both sides are named.

    Returns the scales of the two axes, to draw more on them.
    """
    scales = []
    for way in ("x", "y"):
        path, ends = curve.attrs[way], curve.attrs[f"{way}_range"]
        log = curve.attrs[f"{way}_scale"] == "log"
        scale = scale_of(path, curve[path].attrs["units"], ends, logarithmic=log)
        axis = ax.xaxis if way == "x" else ax.yaxis
        ax.set(**{f"{way}scale": curve.attrs[f"{way}_scale"], f"{way}label": scale.label})
        ax.set(**{f"{way}lim": scale.in_unit(ends)})
        if log:
            axis.set_major_formatter(PLAIN)
        scales.append(scale)
    _name_sides(ax, curve)
    for number in np.unique(curve["branch"].values):
        on = curve["branch"].values == number
        x, y = (
            s.in_unit(curve[curve.attrs[w]].values[on]) for s, w in zip(scales, "xy", strict=True)
        )
        label = "boundary" if number == 0 else None
        ax.plot(x, y, color=BLUE, linewidth=1.8, label=label, zorder=3, clip_on=False)
    return scales[0], scales[1]


def _name_sides(ax: Axes, curve: xr.Dataset) -> None:
    """Tint the unstable side, and label both sides far from the boundary."""
    grid = np.linspace(0.0, 1.0, PIXELS)
    across, up = np.meshgrid(grid, grid)
    signed = signed_distance(curve, across, up)
    if (signed > 0).any():
        ax.contourf(
            across, up, signed, [0.0, np.inf], colors=[UNSTABLE], transform=ax.transAxes, zorder=0
        )
    edge = np.minimum.reduce([across / 1.6, (1 - across) / 1.6, up, 1 - up])  # labels are wide
    for name, side in (("unstable", signed), ("stable", -signed)):
        room = np.minimum(side / 1.6, edge)
        if room.max() > 0.03:
            at = np.unravel_index(np.argmax(room), room.shape)
            ax.text(
                across[at], up[at], name, transform=ax.transAxes, ha="center", va="center", zorder=4
            )


def signed_distance(curve: xr.Dataset, across: Floats, up: Floats) -> Floats:
    """Return the distance to the boundary in fractions of the plane, positive where unstable."""
    ends = []
    for way in ("x", "y"):
        values, limits = curve[curve.attrs[way]].values, curve.attrs[f"{way}_range"]
        if curve.attrs[f"{way}_scale"] == "log":
            values, limits = np.log(values / limits[0]), np.log(limits / limits[0])
        ends.append((values - limits[0]) / (limits[1] - limits[0]))
    joined = np.flatnonzero(np.diff(curve["branch"].values) == 0)
    if len(joined) == 0:
        return np.full(across.shape, np.sign(curve.attrs["growth_rate"]))
    nearest, side = np.full(across.shape, np.inf), np.zeros(across.shape)
    for i in joined:
        (x, y), (dx, dy) = (ends[0][i], ends[1][i]), (np.diff(end[i : i + 2])[0] for end in ends)
        square = max(dx * dx + dy * dy, 1e-30)
        part = np.clip(((across - x) * dx + (up - y) * dy) / square, 0.0, 1.0)
        gap = np.hypot(across - x - part * dx, up - y - part * dy)
        left = (dx * (up - y) - dy * (across - x)) / np.sqrt(square)
        # if two pieces meet in the nearest point, the one seen at the steeper angle decides the
        # side
        closer = gap < nearest * (1 - 1e-9)
        squarer = (gap <= nearest * (1 + 1e-9)) & (np.abs(left) > np.abs(side))
        side = np.where(closer | squarer, left, side)
        nearest = np.minimum(gap, nearest)
    signed: Floats = nearest * np.sign(side)
    return signed


def plot_stability(
    found: Stability, axes: Axes | Sequence[Axes] | None = None
) -> Axes | NDArray[np.object_]:
    """Draw the modes over one parameter, or the boundary in the plane of two.

    Parameters
    ----------
    found : Stability
        From `stiction.stability`.
    axes : Axes or sequence of Axes, optional
        Two for the modes over one parameter, one for the plane of two; by default a new figure as
        wide as a column.

    Returns
    -------
    ndarray of Axes, or Axes
        As of `plot_modes`, or of `plot_boundary`.

    Examples
    --------
    >>> import stiction as st
    >>> axes = st.plotting.plot_stability(st.stability(st.presets.nakano_popov_2020(), over="phi"))
    """
    panels = as_list(axes) if axes is not None else None
    if len(found.criticals) == 2:
        return plot_boundary(found.boundary, ax=panels[0] if panels else None)
    return plot_modes(found.modes, found.criticals[0], panels)
