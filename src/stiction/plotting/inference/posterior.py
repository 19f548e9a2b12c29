"""A fit: prior, posterior, simulations beside the measured record, ranks of a calibration."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.patches import Patch
from numpy.typing import ArrayLike, NDArray

from stiction.analysis.signals.correlated_noise import BOUNDS_95
from stiction.arrays import Floats
from stiction.plotting.page.canvas import canvas, fix_ticks, grid_of
from stiction.plotting.page.parameter import parameter_symbol, use_scale
from stiction.plotting.page.style import BLACK, BLUE, GREY, PAGE, PALE, SKY, style
from stiction.text.paths import short_names
from stiction.text.quantity.prefix import metric_prefix

if TYPE_CHECKING:
    from stiction.auditing.measured import RecordComparison
    from stiction.inference.posterior import Fit

ACROSS = 3, 4  # panels in a row, at least and at most
BINS = 40
FEW_BINS = 24  # of a posterior, whose draws repeat
SHARES = (0.95, 0.5)  # of the posterior inside each contour
SHADES = ("#BBD6E8", BLUE)  # of these regions
SMOOTH = 1.2  # bins: width of the smoothing of a two-dimensional histogram
OUTER = 0.002  # share of the prior beyond each end of an axis
PLAIN = {"deg": " (deg)", "1": ""}  # units without a metric prefix, as on axes
SHARPEST = 6.0  # times as tall as its prior, a posterior is drawn; a sharper one, lower
SHOWN_CYCLES = 5  # cycles
RANK_BINS = 10  # of a histogram of ranks


def plot_posterior(fit: Fit, axes: Sequence[Axes] | None = None) -> NDArray[np.object_]:
    """Draw the posterior of each parameter over its prior, with the 95 % interval.

    Parameters
    ----------
    fit : Fit
        From `stiction.fit`.
    axes : sequence of Axes, optional
        One for each parameter; by default a new figure as wide as a page.

    Returns
    -------
    ndarray of Axes
        One for each parameter.
    """
    names = [*fit.data.data_vars]
    with style():
        panels = panels_of(axes, len(names), 1.6)
        for ax, name, estimate in zip(panels, names, fit.estimates, strict=True):
            said = estimate.name not in fit.unidentified
            draw_parameter(ax, axis_of(fit, name), fit.data[name], fit.prior[name], said)
        panels[0].legend(  # above: a posterior may stand anywhere in the panel
            handles=meanings(panels), loc="lower left", bbox_to_anchor=(-0.03, 1.0), ncols=3,
            columnspacing=1.0, handlelength=1.0,
        )  # fmt: skip
    return np.array(panels, dtype=object)


def meanings(panels: Sequence[Axes]) -> list[Artist]:
    """Return one handle for each thing that some panels show."""
    shown = (zip(*ax.get_legend_handles_labels(), strict=True) for ax in panels)
    return [*{label: handle for each in shown for handle, label in each}.values()]


def panels_of(axes: Sequence[Axes] | None, count: int, height: float) -> Sequence[Axes]:
    """Return the given axes, or one for each parameter on a new page, in rows of a height (in)."""
    fewest, most = ACROSS
    rows = ceil(count / most)
    across = max(ceil(count / rows), fewest)
    panels = grid_of(axes, (PAGE, height * rows + 0.3), rows, across)
    if axes is not None:
        return panels
    for ax in panels[count:]:
        ax.set_axis_off()
    return panels[:count]


JITTERED = "jitter: spread of friction"


class ParameterAxis(NamedTuple):
    """The axis of a parameter: its unit, its label, and whether it is logarithmic.

    It is logarithmic if the prior is uniform in the logarithm, which is then drawn level.
    """

    unit: float
    label: str
    log: bool

    def places(self, values: ArrayLike) -> Floats:
        """Return where values stand: evenly, or by their logarithm."""
        shown = np.asarray(values, dtype=np.float64) / self.unit
        return np.asarray(np.log(shown)) if self.log else shown

    def values_at(self, places: Floats) -> Floats:
        """Return the values at these places, in the unit of the axis."""
        return np.asarray(np.exp(places)) if self.log else places


def axis_of(fit: Fit, name: str) -> ParameterAxis:
    """Return the axis of a parameter by its short name."""
    values = fit.prior[name]
    prior = dict(zip(fit.data.data_vars, fit.plan.priors.values(), strict=True))[name]
    log = getattr(prior, "scale", "") == "log"
    unit = str(values.attrs["units"])
    if unit in PLAIN:
        return ParameterAxis(1.0, f"{_label(name)}{PLAIN[unit]}", log)
    factor, prefix = metric_prefix(np.quantile(np.abs(values.values), 0.9))
    return ParameterAxis(1.0 / factor, f"{_label(name)} ({prefix}{unit})", log)


def _label(name: str) -> str:
    """Return the label of a parameter: its symbol, and for a jitter an explanation."""
    return JITTERED if name == "jitter" else parameter_symbol(name)


def draw_parameter(
    ax: Axes, its: ParameterAxis, after: ArrayLike, before: ArrayLike, identified: bool
) -> None:
    """Draw one parameter's prior, posterior and interval; say so if it is not identified."""
    prior, posterior = its.places(before), its.places(after)
    low, high = np.quantile(prior, [OUTER, 1.0 - OUTER])
    bins = np.linspace(low, high, BINS + 1)
    fine = np.linspace(posterior.min(), posterior.max(), FEW_BINS + 1) if identified else bins
    wide, sharp = (
        np.histogram(values, edges, density=True)[0]
        for values, edges in ((prior, bins), (posterior, fine))
    )
    sharp *= min(1.0, SHARPEST * wide.max() / sharp.max())
    look: dict[str, Any] = {"fill": True, "linewidth": 0.6}
    for heights, edges, face, edge, label in (
        (wide, bins, PALE, GREY, "prior"),
        (sharp, fine, (BLUE, 0.55), BLUE, "posterior"),
    ):
        ax.stairs(
            heights, its.values_at(edges), facecolor=face, edgecolor=edge, label=label, **look
        )
    if identified:
        bounds = its.values_at(np.quantile(posterior, BOUNDS_95))
        for edge, words in zip(bounds, ("95 %", None), strict=True):
            ax.axvline(edge, color=BLUE, linewidth=0.8, linestyle=(0, (4, 2)), label=words)
    else:
        ax.set_title("not identifiable", color=GREY)
    use_scale(ax, "x", its.log)
    ax.set(xlim=its.values_at(np.array([low, high])), yticks=[], xlabel=its.label)


def plot_corner(
    fit: Fit, names: Sequence[str] | None = None, axes: NDArray[np.object_] | None = None
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
    short = short_names(x.name for x in fit.estimates)
    found = [short[x.name] for x in fit.estimates if x.identified]
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
                after, before = fit.data[chosen[i]], fit.prior[chosen[i]]
                draw_parameter(ax, axis_of(fit, chosen[i]), after, before, True)
            else:
                draw_pair(ax, fit, chosen[j], chosen[i])
            ax.tick_params(labelleft=j == 0 and i > 0, labelbottom=i == count - 1)
            ax.set_xlabel(axis_of(fit, chosen[j]).label if i == count - 1 else "")
            ax.set_ylabel(axis_of(fit, chosen[i]).label if j == 0 and i > 0 else "")
            ax.tick_params(axis="x", labelrotation=45.0)
        for j, name in enumerate(chosen):
            its = axis_of(fit, name)
            limits = np.quantile(its.places(fit.prior[name]), [OUTER, 1.0 - OUTER])
            seen = np.quantile(its.places(fit.data[name]), [0.0, 1.0])
            margin = 0.15 * float(np.ptp(seen))
            ends = max(limits[0], seen[0] - margin), min(limits[1], seen[1] + margin)
            near = its.values_at(np.array(ends))
            for i in range(j, count):
                grid[i, j].set_xlim(near)
            for i in range(j):
                grid[j, i].set_ylim(near)
        if count > 1:  # beside the diagonal
            regions = (
                Patch(facecolor=shade, label=f"{share:.0%} of a pair".replace("%", " %"))
                for shade, share in zip(SHADES, SHARES, strict=True)
            )
            grid[0, 1].legend(handles=[*meanings([grid[0, 0]]), *regions], loc="upper left")
        if axes is None:
            grid[0, 0].figure.align_xlabels(grid[-1])
    return np.asarray(grid, dtype=object)


def draw_pair(ax: Axes, fit: Fit, x: str, y: str) -> None:
    """Draw the regions of two parameters that hold 95 % and 50 % of the posterior."""
    from scipy.ndimage import gaussian_filter  # type: ignore[attr-defined]

    own = axis_of(fit, x), axis_of(fit, y)
    a, b = (its.places(fit.data[name]) for its, name in zip(own, (x, y), strict=True))
    counts, xs, ys = np.histogram2d(a, b, bins=BINS)
    smooth = gaussian_filter(np.pad(counts, 3), SMOOTH)
    ordered = np.sort(smooth.ravel())[::-1]
    shares = np.cumsum(ordered) / ordered.sum()
    levels = [float(ordered[np.searchsorted(shares, share)]) for share in SHARES]
    centres = [
        its.values_at(np.arange(-3, len(edges) + 2) * (edges[1] - edges[0]) + edges[:2].mean())
        for its, edges in zip(own, (xs, ys), strict=True)
    ]
    edges = sorted({*levels, float(smooth.max())})
    if len(edges) == len(levels) + 1:
        ax.contourf(*centres, smooth.T, levels=edges, colors=SHADES)
    use_scale(ax, "x", own[0].log)
    use_scale(ax, "y", own[1].log)


def plot_predictive(
    comparison: RecordComparison, axes: Sequence[Axes] | None = None
) -> NDArray[np.object_]:
    """Draw a record over a simulation with the fitted parameters, and both loading curves.

    Parameters
    ----------
    comparison : Comparison
        Of `stiction.audit` of a rig and a record: ``audit(rig, record=record).measured``.
    axes : sequence of Axes, optional
        Three; by default a new figure as wide as a page.

    Returns
    -------
    ndarray of Axes
        Force over time, from a trough on; loading curves with the 95 % predictive band; how far
        they are from straight.
    """
    with style():
        panels = grid_of(axes, (PAGE, 2.4), 1, 3, width_ratios=(1.4, 1, 1))
        draw_cycles(panels[0], comparison.seen, comparison.predictive)
        draw_loading(panels[1:], comparison.predictive)
        for ax, shown in zip(panels, ((0, 1), (0, 2), (1,)), strict=True):  # curves fill panels
            handles, labels = ax.get_legend_handles_labels()
            ax.legend(
                [handles[i] for i in shown], [labels[i] for i in shown],
                loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2,
            )  # fmt: skip
    return np.array(panels, dtype=object)


def draw_cycles(ax: Axes, seen: Any, found: Any) -> None:
    """Draw some cycles of a record over simulated ones."""
    factor, prefix = metric_prefix(found.measured.force)
    step = seen.conditions.step
    example = found.example.channels["force"], found.example.cycles
    for (force, cycles), color, width, label in (
        (example, SKY, 1.8, "simulated"),
        ((seen.force, seen.cycles), BLACK, 0.7, "measured"),
    ):
        part = (
            factor
            * force[cycles.before[0] : cycles.after[min(SHOWN_CYCLES, len(cycles.after)) - 1]]
        )
        ax.plot(step * np.arange(len(part)), part, color=color, linewidth=width, label=label)
    ax.set(xlabel="time from a trough (s)", ylabel=f"force ({prefix}N)")


def draw_loading(panels: Sequence[Axes], found: Any) -> None:
    """Draw loading curves and their bend, each with its predictive band."""
    factor, prefix = metric_prefix(found.measured.force)
    share, names = np.linspace(0.0, 100.0, len(found.measured.force)), ("force", "bend")
    for ax, name, scale, (low, high) in zip(
        panels, names, (factor, 100.0), found.bands, strict=True
    ):
        ax.fill_between(share, scale * low, scale * high, color=PALE, label="simulated, 95 %")
        mean = getattr(found.simulated, name).mean(axis=0)
        ax.plot(share, scale * mean, color=BLUE, linewidth=0.8, label="simulated, mean")
        ax.plot(share, scale * getattr(found.measured, name), color=BLACK, label="measured")
        ax.set(xlabel="share of a loading (%)")
    panels[0].set_ylabel(f"force ({prefix}N)")
    panels[1].set_ylabel("bend (% of the rise)")


def plot_ranks(fit: Fit, axes: Sequence[Axes] | None = None) -> NDArray[np.object_]:
    """Draw the ranks of the truth in posteriors of simulated records: even, if calibrated.

    Parameters
    ----------
    fit : Fit
        From `stiction.fit`.
    axes : sequence of Axes, optional
        One for each parameter; by default a new figure as wide as a page.

    Returns
    -------
    ndarray of Axes
        One for each parameter; grey, where 95 % of the counts lie if ranks are uniform.
    """
    from scipy.stats import binom  # type: ignore[attr-defined]

    names = [*fit.data.data_vars]
    low, high = binom.ppf(BOUNDS_95, len(fit.ranks), 1.0 / RANK_BINS)
    with style():
        panels = panels_of(axes, len(names), 1.5)
        for ax, name, ranks in zip(panels, names, fit.ranks.T, strict=True):
            ax.axhspan(low, high, color=PALE, zorder=0)
            edges = np.linspace(0.0, 1.0, RANK_BINS + 1).tolist()
            ax.hist(ranks, edges, histtype="step", color=BLUE)
            ax.axhline(len(ranks) / RANK_BINS, color=GREY, linewidth=0.6)
            ax.set(
                xlim=(0.0, 1.0), ylim=(0.0, 2.0 * high), xticks=[0.0, 0.5, 1.0], yticks=[],
                title=name, xlabel="rank of the truth",
            )  # fmt: skip
    return np.array(panels, dtype=object)
