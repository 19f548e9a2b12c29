"""Prior against posterior, a panel for each parameter, and a corner of all pairs."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from stiction.arrays import xr
from stiction.plotting.page.canvas import as_list, canvas, fix_ticks
from stiction.plotting.page.style import BLUE, GREY, PAGE, PALE, style
from stiction.text.paths import last_part
from stiction.text.quantity_text import metric_prefix

ACROSS = 4  # panels in a row
BINS = 40
FEW_BINS = 24  # of a posterior, whose draws repeat
SHARES = (0.95, 0.5)  # of the posterior inside each contour
SMOOTH = 1.2  # bins: width of the smoothing of a two-dimensional histogram
OUTER = 0.002  # share of the prior beyond each end of an axis
PLAIN = {"deg": " (deg)", "1": ""}  # units without a metric prefix, as on axes


def plot_posterior(fit: Any, axes: Sequence[Axes] | None = None) -> NDArray[np.object_]:
    """Draw the posterior of each parameter over its prior, with the 95 % interval.

    Parameters
    ----------
    fit : Fit
        From `stiction.fit`.
    axes : sequence of Axes, optional
        One for each parameter; a new figure as wide as a page when left out.

    Returns
    -------
    ndarray of Axes
        One for each parameter.
    """
    names = [*fit.data.data_vars]
    with style():
        panels = panels_of(axes, len(names), 1.5)
        for ax, name, estimate in zip(panels, names, fit.estimates, strict=True):
            draw_parameter(ax, fit.data[name], fit.prior[name], estimate.identified)
        panels[0].legend(loc="upper right", handlelength=1.0)
    return np.array(panels, dtype=object)


def panels_of(axes: Sequence[Axes] | None, count: int, height: float) -> Sequence[Axes]:
    """Return the given axes, or one for each parameter on a new page, in rows of a height (in)."""
    if axes is not None:
        return as_list(axes)
    rows = ceil(count / ACROSS)
    grid = canvas(PAGE, height * rows + 0.3).subplots(rows, ACROSS, squeeze=False).ravel()
    for ax in grid[count:]:
        ax.set_axis_off()
    return fix_ticks(list(grid[:count]))


def draw_parameter(ax: Axes, after: xr.DataArray, before: xr.DataArray, identified: bool) -> None:
    """Draw one parameter's prior, posterior and interval; say so if it is not identified."""
    scale, label = axis_unit(before)
    prior, posterior = before.values / scale, after.values / scale
    low, high = np.quantile(prior, [OUTER, 1.0 - OUTER])
    bins = np.linspace(low, high, BINS + 1)
    look: dict[str, Any] = {"density": True, "histtype": "stepfilled"}
    ax.hist(prior, bins.tolist(), color=PALE, edgecolor=GREY, linewidth=0.6, label="prior", **look)
    fine = np.linspace(posterior.min(), posterior.max(), FEW_BINS + 1) if identified else bins
    ax.hist(posterior, fine.tolist(), color=BLUE, alpha=0.55, label="posterior", **look)
    if identified:
        for edge in np.quantile(posterior, [0.025, 0.975]):
            ax.axvline(edge, color=BLUE, linewidth=0.8, linestyle=(0, (4, 2)))
    else:
        ax.set_title("not identifiable", color=GREY)
    ax.set(xlim=(low, high), yticks=[], xlabel=label)


def axis_unit(values: xr.DataArray) -> tuple[float, str]:
    """Return what values are divided by for their axis, and its label."""
    unit = str(values.attrs["units"])
    if unit in PLAIN:
        return 1.0, f"{values.name}{PLAIN[unit]}"
    factor, prefix = metric_prefix(np.quantile(np.abs(values.values), 0.9))
    return 1.0 / factor, f"{values.name} ({prefix}{unit})"


def plot_corner(
    fit: Any, names: Sequence[str] | None = None, axes: Any = None
) -> NDArray[np.object_]:
    """Draw the posterior of all pairs of parameters: regions that hold 50 % and 95 % of it.

    Parameters
    ----------
    fit : Fit
        From `stiction.fit`.
    names : sequence of str, optional
        Of the parameters; by default those that are identified.
    axes : ndarray of Axes, optional
        As many rows and columns as parameters; a new figure by default.

    Returns
    -------
    ndarray of Axes
        (n, n); those above the diagonal are empty.
    """
    found = [last_part(x.name) for x in fit.estimates if x.identified]
    chosen = [*names] if names is not None else found or [*fit.data.data_vars]
    count = len(chosen)
    with style():
        grid: Any = axes
        if axes is None:
            size = min(PAGE, 1.2 * count + 0.8)
            grid = canvas(size, size).subplots(count, count, squeeze=False, sharex="col")
        fix_ticks(list(grid.ravel()))
        for i, j in np.ndindex(count, count):
            ax = grid[i, j]
            if j > i:
                ax.set_axis_off()
            elif i == j:
                draw_parameter(ax, fit.data[chosen[i]], fit.prior[chosen[i]], True)
            else:
                draw_pair(ax, fit, chosen[j], chosen[i])
            ax.tick_params(labelleft=j == 0 and i > 0, labelbottom=i == count - 1)
            ax.set_xlabel(axis_unit(fit.prior[chosen[j]])[1] if i == count - 1 else "")
            ax.set_ylabel(axis_unit(fit.prior[chosen[i]])[1] if j == 0 and i > 0 else "")
            ax.tick_params(axis="x", labelrotation=45.0)
        for j, name in enumerate(chosen):
            scale, _ = axis_unit(fit.prior[name])
            limits = np.quantile(fit.prior[name].values / scale, [OUTER, 1.0 - OUTER])
            seen = np.quantile(fit.data[name].values / scale, [0.0, 1.0])
            margin = 0.15 * float(np.ptp(seen))
            near = max(limits[0], seen[0] - margin), min(limits[1], seen[1] + margin)
            for i in range(j, count):
                grid[i, j].set_xlim(near)
            for i in range(j):
                grid[j, i].set_ylim(near)
    return np.asarray(grid, dtype=object)


def draw_pair(ax: Axes, fit: Any, x: str, y: str) -> None:
    """Draw the regions of two parameters that hold 95 % and 50 % of the posterior."""
    from scipy.ndimage import gaussian_filter  # type: ignore[attr-defined]

    (x_scale, _), (y_scale, _) = axis_unit(fit.prior[x]), axis_unit(fit.prior[y])
    a, b = fit.data[x].values / x_scale, fit.data[y].values / y_scale
    counts, xs, ys = np.histogram2d(a, b, bins=BINS)
    smooth = gaussian_filter(np.pad(counts, 3), SMOOTH)
    ordered = np.sort(smooth.ravel())[::-1]
    shares = np.cumsum(ordered) / ordered.sum()
    levels = [float(ordered[np.searchsorted(shares, share)]) for share in SHARES]
    centres = [
        np.arange(-3, len(edges) + 2) * (edges[1] - edges[0]) + 0.5 * (edges[0] + edges[1])
        for edges in (xs, ys)
    ]
    edges = sorted({*levels, float(smooth.max())})
    if len(edges) == len(levels) + 1:
        ax.contourf(*centres, smooth.T, levels=edges, colors=["#BBD6E8", BLUE])
