"""Slip speeds of several runs on a logarithmic axis, with rows for zero slip."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from stiction.analysis.motion.cycles import find_cycles
from stiction.analysis.motion.rest import stuck_until
from stiction.analysis.slip import cell_force
from stiction.plotting.page.style import GREY
from stiction.plotting.run.curves import (
    RunCurve,
    common,
    draw_curve,
    fit_time,
    force_symbol,
    mark_early_end,
)
from stiction.plotting.run.time_series import DEEPEST, fastest_drive, say_only, set_speed_limits
from stiction.trajectory import Trajectory

ROW = 0.8  # height of a filled row
MANY, LAST = 8, 5  # cycles: of a run with more than the first, only the last ones are seen apart
IN_TIME, BY_FORCE = 300, 120  # bins of a row over time and over force


def draw_speeds(ax: Axes, curves: Sequence[RunCurve]) -> None:
    """Draw the slip speed (m/s) over time: its mean, and a band up to its maximum.

    The minimum is not drawn: it is zero wherever the mass comes to rest.
    """
    ax.set_yscale("log", nonpositive="mask")
    ax.set_ylabel(r"$v_\mathrm{slip}$ (m/s)")
    for curve in curves:
        slip = curve.slip
        mean = np.where(slip.mean > DEEPEST * fastest_drive(curve.run), slip.mean, np.nan)
        ax.fill_between(slip.time, mean, slip.high, color=curve.color, alpha=0.18, linewidth=0)
        draw_curve(ax, curve, slip.time, mean)
        mark_early_end(ax, curve, slip.time[-1], mean[-1])
    fit_time(ax, curves)


def _portrayed_from(run: Trajectory) -> float:
    """Return the time from which a phase portrait shows a run, s: its last cycles, if it has many.

    Loops of many irregular cycles would cover each other.
    """
    starts = find_cycles(run)["start"].values
    return float(starts[-LAST] if len(starts) > MANY else run.samples["time"][0])


def draw_portrait(ax: Axes, curves: Sequence[RunCurve]) -> None:
    """Draw the mean slip speed (m/s) over the spring force; of many cycles, the last ones."""
    ax.set_yscale("log", nonpositive="mask")
    factor, _ = common(cell_force(curve.run) for curve in curves)
    for curve in curves:
        slip = curve.slip
        mean = np.where(slip.mean > DEEPEST * fastest_drive(curve.run), slip.mean, np.nan)
        seen = slip.time >= _portrayed_from(curve.run)
        ax.plot(slip.force[seen] * factor, mean[seen], **curve.look)
        mark_early_end(ax, curve, slip.force[-1] * factor, mean[-1])


def set_limits(ax: Axes, curves: Sequence[RunCurve]) -> None:
    """Fit the axis of slip speed to the lines; say so if nothing slips."""
    if not set_speed_limits(ax, [(curve.slip, fastest_drive(curve.run)) for curve in curves]):
        say_only(ax, "no slip")


def draw_rests(ax: Axes, curves: Sequence[RunCurve]) -> None:
    """Draw the share of time at zero slip over time, a filled row for each run."""
    first = curves[0].run.samples["time"]
    end = max(float(curve.run.samples["time"][-1]) for curve in curves)
    edges = np.linspace(first[0], max(end, np.nextafter(first[0], np.inf)), IN_TIME + 1)
    for row, curve in enumerate(curves):
        share = np.diff(stuck_until(edges, curve.run.stick_intervals)) / np.diff(edges)
        fill_row(ax, row, share, edges, curve)
    finish_rows(ax, len(curves))
    ax.set_ylabel("zero\nslip", rotation=0, ha="right", va="center")
    ax.set_xlabel("time $t$ (s)")
    ax.set_xlim(edges[0], edges[-1])


def draw_held(ax: Axes, curves: Sequence[RunCurve]) -> None:
    """Draw the share of time at zero slip over the spring force, a filled row for each run."""
    forces = [cell_force(curve.run) for curve in curves]
    factor, prefix = common(forces)
    finite = np.concatenate([force[np.isfinite(force)] for force in forces]) * factor
    low, high = (finite.min(), finite.max()) if len(finite) else (0.0, 1.0)
    pad = 0.04 * (high - low) or 1.0
    edges = np.linspace(low - pad, high + pad, BY_FORCE + 1)
    for row, (curve, force) in enumerate(zip(curves, forces, strict=True)):
        times = curve.run.samples["time"]
        # however short: all are counted
        stuck = np.diff(stuck_until(times, curve.run.stick_intervals))
        total, _ = np.histogram(force[:-1] * factor, edges, weights=np.diff(times))
        held, _ = np.histogram(force[:-1] * factor, edges, weights=stuck)
        share = np.divide(held, total, out=np.zeros(BY_FORCE), where=total > 0)
        fill_row(ax, row, share, edges, curve)
    finish_rows(ax, len(curves))
    ax.set_xlabel(f"{force_symbol(curves[0].run.slider)} ({prefix}N)")
    ax.set_xlim(edges[0], edges[-1])


def fill_row(ax: Axes, row: int, share: np.ndarray, edges: np.ndarray, curve: RunCurve) -> None:
    """Fill a row, counted from the top, to the height of the share 0 to 1."""
    ax.stairs(-row - 1 + ROW * share, edges, baseline=-row - 1, fill=True, color=curve.color)


def finish_rows(ax: Axes, rows: int) -> None:
    """Rule the rows, and remove the ticks, which are meaningless there."""
    ax.set_ylim(-rows - 0.1, 0.0)
    ax.tick_params(axis="y", left=False, right=False, labelleft=False)
    for row in range(rows):
        ax.axhline(-row - 1, color=GREY, linewidth=0.3, zorder=1)
