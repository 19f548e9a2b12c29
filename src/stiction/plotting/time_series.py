"""Quantities of a run over time, one function a quantity."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import StepPatch
from matplotlib.ticker import FuncFormatter, MaxNLocator
from numpy.typing import ArrayLike, NDArray

from stiction.analysis.stuck import stuck_until
from stiction.plotting.style import BLACK, BLUE, GREEN, GREY, PURPLE, RED
from stiction.quantity_text import SI, thousands
from stiction.trajectory import Trajectory

Floats = NDArray[np.float64]

FEW = 50  # so few samples are shown as such: what happens between them is not known


def envelope(time: ArrayLike, values: ArrayLike, bins: int = 1500) -> tuple[Floats, Floats]:
    """Thin out a long series so that its line looks the same: extremes of each of `bins` bins.

    Parameters
    ----------
    time, values : array
        (n,); not-a-number values leave gaps only where a whole bin lacks a value.
    bins : int
        More than a printed line has dots.

    Returns
    -------
    time, values : ndarray
        (2 bins,), or what was given if that is not longer.
    """
    t, v = np.asarray(time, dtype=np.float64), np.asarray(values, dtype=np.float64)
    if len(t) <= 2 * bins:
        return t, v
    starts = np.linspace(0, len(t), bins, endpoint=False).astype(np.intp)
    middle = 0.5 * (t[starts] + t[np.r_[starts[1:], len(t)] - 1])
    low, high = np.fmin.reduceat(v, starts), np.fmax.reduceat(v, starts)
    return np.repeat(middle, 2), np.column_stack([low, high]).ravel()


def draw_line(
    ax: Axes, time: ArrayLike, values: ArrayLike, color: str = BLACK, width: float = 0.7
) -> Line2D:
    """Draw values over time (s), thinned out by `envelope`; `width` in pt."""
    times = np.asarray(time)
    (line,) = ax.plot(*envelope(times, values), color=color, linewidth=width)
    if len(times) <= FEW:
        line.set(linestyle="none", marker="o", markersize=2.5, clip_on=False, zorder=3)
    if times[-1] > times[0]:
        ax.set_xlim(times[0], times[-1])
    return line


def draw_quantity(
    ax: Axes, run: Trajectory, variable: str, symbol: str, color: str = BLACK
) -> Line2D:
    """Draw a variable of the run over time, in the multiple of its unit that suits its size."""
    data = run.data[variable]
    return draw_values(ax, run, data.values, symbol, data.attrs["units"], color)


def draw_values(
    ax: Axes, run: Trajectory, values: ArrayLike, symbol: str, unit: str, color: str = BLACK
) -> Line2D:
    """Draw values of one unit over the run's time, in the multiple that suits their size."""
    array = np.asarray(values, dtype=np.float64)
    factor, prefix = prefixed(array)
    ax.set_ylabel(f"{symbol} ({prefix}{unit})")
    return draw_line(ax, run.data["time"].values, array * factor, color)


def imposed(run: Trajectory) -> list[tuple[str, Floats, str, str]]:
    """Return what a protocol imposes and is not constant: its name, values, symbol, unit.

    Drive velocity along X and across it, and normal load.
    """
    names = (("drive_X", "$V$"), ("drive_Y", "$V_Y$"), ("normal_load", "$W$"))
    found = [(name, run.data[name], symbol) for name, symbol in names]
    return [
        (name, each.values, symbol, each.attrs["units"])
        for name, each, symbol in found
        if np.ptp(each.values) > 0
    ]


def prefixed(values: ArrayLike) -> tuple[float, str]:
    """Return factor and prefix (n, µ, m, none, k) of a unit in which values are about 1 to 100."""
    largest = np.fmax.reduce(np.abs(np.asarray(values, dtype=np.float64)), initial=0.0)
    if not 0 < largest < np.inf:
        return 1.0, ""
    power = min(max(thousands(5.0 * largest, "m"), -3), 1)
    return 1000.0**-power, SI[power]


def name_time(ax: Axes) -> None:
    """Write a time axis, whose values are in s, in the unit that suits what it shows: s, ms, ..."""
    factor, prefix = prefixed(ax.get_xlim())
    factor, prefix = (factor, prefix) if factor > 1.0 else (1.0, "")
    ax.xaxis.set_major_formatter(FuncFormatter(lambda t, _: f"{factor * t:.10g}"))
    ax.set_xlabel(f"time $t$ ({prefix}s)")


def draw_spring_force(ax: Axes, run: Trajectory, axis: str, color: str = RED) -> Line2D:
    """Draw the spring force along the principal axis ``"x"`` or ``"y"`` over time."""
    return draw_quantity(ax, run, f"spring_{axis}", rf"$k_{axis} u_{axis}$", color)


def draw_friction(ax: Axes, run: Trajectory) -> Line2D:
    """Draw the magnitude of the friction force over time; while stuck, the force that holds."""
    return draw_quantity(ax, run, "friction", "$F$", PURPLE)


def draw_direction(ax: Axes, run: Trajectory) -> Line2D:
    """Draw the friction angle psi (deg) to the drive direction over time."""
    ax.yaxis.set_major_locator(MaxNLocator(nbins=4, steps=[1, 1.5, 3, 4.5, 9, 10]))
    ax.set_ylabel(r"$\psi$ (deg)")
    return draw_line(ax, run.data["time"].values, cut_open(run.data["psi"].values), PURPLE)


def cut_open(angles: ArrayLike) -> Floats:
    """Return angles (deg) on the turn that begins where none, or the fewest, of them lie.

    Sliding back and forth has angles about 0 and 180 degrees: cut there, a line over time would
    jump from edge to edge. Cut at 180 degrees where that does as well.
    """
    values = np.asarray(angles, dtype=np.float64)
    edges = np.arange(-180.0, 181.0, 10.0)
    count, _ = np.histogram(np.mod(values[np.isfinite(values)] + 180.0, 360.0) - 180.0, edges)
    beside = count + np.roll(count, 1)  # of each edge
    start = edges[0] if beside[0] == 0 else edges[int(np.argmin(beside))]
    start -= 360.0 if start > 0.0 else 0.0  # the turn that lies nearest to zero
    opened: Floats = np.mod(values - start, 360.0) + start
    return opened


def draw_position(ax: Axes, run: Trajectory) -> Line2D:
    """Draw the position X along the drive direction over time."""
    return draw_quantity(ax, run, "X", "$X$", BLUE)


def draw_rate(ax: Axes, run: Trajectory, axis: str) -> Line2D:
    """Draw the elongation rate along the principal axis ``"x"`` or ``"y"`` over time."""
    return draw_quantity(ax, run, f"v_{axis}", rf"$v_{axis}$", RED)


def draw_slip_speed(ax: Axes, run: Trajectory) -> Line2D:
    """Draw the slip speed (m/s) over time on a logarithmic axis; gaps where it is zero.

    Speeds below 1e-7 of the largest are left out, so that a landing does not stretch the axis.
    """
    speed = run.data["slip_speed"].values
    largest = np.fmax.reduce(speed, initial=0.0)
    ax.set_ylabel(r"$v_\mathrm{slip}$ (m/s)")
    if not largest > 0:
        return draw_line(ax, run.data["time"].values, speed, GREEN)
    ax.set_yscale("log")
    shown = np.where(speed > 1e-7 * largest, speed, np.nan)
    return draw_line(ax, run.data["time"].values, shown, GREEN)


def draw_time_stuck(ax: Axes, run: Trajectory, bins: int = 300) -> StepPatch:
    """Draw the share of time (%) spent at zero slip, from every stick interval of the run.

    Stick intervals can be far shorter than the sample interval and number thousands; their share
    in each of `bins` bins shows them all.
    """
    times = run.data["time"].values
    edges = np.linspace(times[0], max(times[-1], np.nextafter(times[0], np.inf)), bins + 1)
    share = 100.0 * np.diff(stuck_until(edges, run.stick_intervals)) / np.diff(edges)
    ax.set_ylabel("stuck (%)")
    ax.set_ylim(0, 105)
    return ax.stairs(share, edges, fill=True, color=GREY)
