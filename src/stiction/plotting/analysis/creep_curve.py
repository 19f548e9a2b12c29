"""Creep curves: each stick phase, their mean with its uncertainty, and theory."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator

from stiction import theory
from stiction.arrays import Floats, xr
from stiction.plotting.page.canvas import panel
from stiction.plotting.page.parameter import PLAIN, label_decades
from stiction.plotting.page.style import BLACK, GREY, LINES, style

Line = Callable[[Floats], Any]  # time to slip (s) to velocity (m/s)


def creep_theory(
    V: float, phi: float, l_x: float, slip_time: float | None = None
) -> dict[str, Line]:
    """Return Eqs. (7) and (8) as functions of the time to slip.

    Slip comes in a loading that starts at t = 0 with an unloaded spring at `slip_time`, s; by
    default at V t = l_x. Inertia makes it later.
    """
    formulas = {
        "Eq. (7), closed form": theory.creep_velocity,
        "Eq. (8), corrected": theory.creep_velocity_approximation,
    }

    end = l_x / V if slip_time is None else slip_time

    def before_slip(formula: Callable[..., Any]) -> Line:
        return lambda to_slip: formula(end - to_slip, V, phi, l_x)

    return {label: before_slip(formula) for label, formula in formulas.items()}


MOST_BINS = 0.9  # of the bins: so many must stand out of their errors for a logarithmic axis
TOP, THIN = 1.8, 0.8  # line widths, pt: of the first theory, which lies over the others
FEW_PHASES = 20  # stick phases, of which each curve can be seen


def draw_phases(ax: Axes, curves: xr.Dataset, V: float) -> None:
    """Draw the creep of every stick phase, as a share of the drive velocity `V` (m/s).

    Of many phases the curves would be a hatching: the middle half of them is drawn.
    """
    if curves.sizes["phase"] > FEW_PHASES:
        draw_middle_half(ax, curves, V)
        return
    faint = min(0.5, 4.0 / max(curves.sizes["phase"], 1))
    for phase in range(curves.sizes["phase"]):
        row = curves.isel(phase=phase)
        middle = 0.5 * (row["begin"] + row["end"]).values
        label = "each stick phase" if phase == 0 else None
        ax.plot(middle, row["velocity"].values / V, color=BLACK, lw=0.4, alpha=faint, label=label)


def draw_middle_half(ax: Axes, curves: xr.Dataset, V: float) -> None:
    """Draw the quartiles of the creep of all stick phases, where at least four reach."""
    velocity = curves["velocity"].values / V
    several = np.isfinite(velocity).sum(axis=0) > 3
    middle = np.broadcast_to(0.5 * (curves["begin"] + curves["end"]).values, velocity.shape)
    quartiles = np.nanquantile(velocity[:, several], (0.25, 0.75), axis=0)
    for each, label in zip(quartiles, ("middle half of the stick phases", None), strict=True):
        at = np.nanmedian(middle[:, several], axis=0)
        ax.plot(at, each, color=BLACK, lw=0.7, ls=":", label=label)


def draw_mean(ax: Axes, mean: xr.Dataset, V: float) -> None:
    """Draw the mean creep curve with a band of two standard errors to each side.

    Where one phase alone is so long, as the first of a run from rest, that phase is all there is.
    """
    several = mean["phases"].values > 1
    mean = mean.isel(bin=several) if several.any() else mean
    middle = 0.5 * (mean["begin"] + mean["end"]).values
    value, error = mean["velocity"].values / V, 2.0 * mean["velocity_error"].values / V
    band = "two standard errors"
    ax.fill_between(middle, value - error, value + error, color=BLACK, alpha=0.2, lw=0, label=band)
    ax.plot(middle, value, "o", color=BLACK, markersize=2.6, label="mean of these", zorder=3)


def plot_creep(
    curves: xr.Dataset,
    mean: xr.Dataset,
    V: float,
    lines: Mapping[str, Line] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw creep curves over the time to slip; slip is at the right.

    The velocity is on a logarithmic axis if the mean is positive, and nearly everywhere above twice
    its error, so that spikes of single phases hide nothing; on a linear one otherwise, where noise
    has both signs. The first line of theory lies over the others, which are thin.

    Parameters
    ----------
    curves, mean : Dataset
        From `stiction.analysis.creep_curves` and `stiction.analysis.mean_creep`.
    V : float
        Drive velocity, m/s.
    lines : mapping of str to callable, optional
        What to compare with, each by its name: velocity (m/s) as a function of the time to slip
        (s), from `creep_theory` or a fit's ``velocity``.
    ax : Axes, optional
        Drawn on; by default a new figure as wide as a column.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "5 s", sample_rate="2 kHz")
    >>> curves = st.analysis.creep_curves(run, st.analysis.find_cycles(run))
    >>> ax = st.plotting.plot_creep(curves, st.analysis.mean_creep(curves), V=1e-3)
    """
    middle = 0.5 * (mean["begin"] + mean["end"]).values
    value, error = mean["velocity"].values, np.nan_to_num(mean["velocity_error"].values)
    with style():
        ax = panel(ax, 2.9)
        draw_phases(ax, curves, V)
        draw_mean(ax, mean, V)
        to_slip = np.geomspace(0.5 * middle.min(), middle.max(), 400)
        for at, ((label, line), (color, dashes)) in enumerate(
            zip((lines or {}).items(), LINES, strict=False)
        ):
            drawn = np.asarray(line(to_slip), dtype=np.float64) / V
            (its,) = ax.plot(to_slip, drawn, color=color, linestyle=dashes, label=label)
            its.set(linewidth=THIN if at else TOP, zorder=2.9 - 0.1 * at)
        ax.set(xscale="log", xlim=(to_slip[-1] * 1.05, to_slip[0]))
        label_decades(ax.xaxis, to_slip[0], to_slip[-1])
        sure = value > 2.0 * error
        if sure.mean() >= MOST_BINS and (value > 0.0).all():
            lowest = 0.5 * float(value[sure].min()) / V
            ax.set(yscale="log", ylim=(lowest, 1.5))
            if lowest > 0.05:  # less than two decades: write all labels
                ax.yaxis.set_major_formatter(PLAIN)
                ax.yaxis.set_minor_formatter(PLAIN)
                ax.yaxis.set_minor_locator(LogLocator(subs=(2.0, 5.0)))
        else:
            ax.axhline(0.0, color=GREY, linewidth=0.6, zorder=1)
            lowest = float(np.nanmin(value - 2.0 * error, initial=0.0)) / V
            seen = [(value + 2.0 * error) / V, *(each.get_ydata() for each in ax.get_lines())]
            highest = min(1.1 * float(np.nanmax(np.concatenate(seen), initial=0.05)), 1.3)
            ax.set_ylim(min(-0.05 * highest, max(-0.4, 1.1 * lowest)), highest)
        ax.set_xlabel("time to slip (s)")
        ax.set_ylabel(r"creep velocity $\dot{X}/V$ (1)")
        ax.text(
            0.03, 0.95, "time runs \N{RIGHTWARDS ARROW}", transform=ax.transAxes, va="top",
            color=GREY, fontsize=7,
        )  # fmt: skip
        low, high = ax.get_ylim()
        for each in ax.get_lines():  # curves outside are not in the legend
            seen_y = np.asarray(each.get_ydata(), dtype=np.float64)
            if not ((seen_y > low) & (seen_y < high)).any():
                each.set_label("_outside")
        legend = ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
        legend.get_lines()[0].set_alpha(0.5)
    return ax
