"""Several runs as curves in one panel, distinct in colour and line style."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from stiction.analysis.slip import Slip, cell_force, cell_symbol
from stiction.arrays import Floats
from stiction.plotting.page.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, RED, SKY
from stiction.plotting.run.lines import draw_line
from stiction.plotting.run.time_series import DEEPEST, average_slip, fastest_drive, say_only, stays
from stiction.system.slider import Slider
from stiction.text.quantity.prefix import metric_prefix
from stiction.trajectory import Trajectory

COLOURS = (BLACK, RED, BLUE, GREEN, ORANGE, SKY, PURPLE)
DASHES: tuple[Any, ...] = ("solid", (0, (5, 1.5)), (0, (7, 1.2, 1.2, 1.2)), (0, (1.4, 1.1)))

NARROW, BROAD = 0.9, 1.5  # pt, lines: the first is broad, below the others
UNITS = {"force": "N", "X": "m"}


class RunCurve(NamedTuple):
    """One run, its label, its line style, and its slip averaged over short times."""

    label: str
    run: Trajectory
    look: dict[str, Any]
    slip: Slip

    @property
    def color(self) -> str:
        """The colour of its lines."""
        return str(self.look["color"])

    @property
    def speed(self) -> Floats:
        """Its mean slip speed (m/s), NaN where the mass rests: for a logarithmic axis."""
        slides = self.slip.mean > DEEPEST * fastest_drive(self.run)
        return np.where(slides, self.slip.mean, np.nan)


def curves_of(runs: Mapping[str, Trajectory]) -> list[RunCurve]:
    """Return a curve for each run; no two of the first 28 look alike.

    The first is a broad line below the others, and solid lines lie below dashed ones: all are
    visible where they agree.
    """
    return [
        RunCurve(
            label,
            run,
            {
                "color": COLOURS[at % len(COLOURS)],
                "linestyle": DASHES[at % len(DASHES)],
                "linewidth": NARROW if at else BROAD,
                "zorder": 2.0 + 0.01 * at + 0.3 * (at % len(DASHES) > 0),
            },
            average_slip(run),
        )
        for at, (label, run) in enumerate(runs.items())
    ]


def common(values: Iterable[ArrayLike]) -> tuple[float, str]:
    """Return factor and prefix of the unit that suits all values together; see `metric_prefix`."""
    largest = [np.fmax.reduce(np.abs(np.asarray(each)), initial=0.0) for each in values]
    return metric_prefix([value for value in largest if np.isfinite(value)])


def force_symbol(slider: Slider) -> str:
    """Return the name of the load cell's force for an axis."""
    name = cell_symbol(slider)
    return f"${name}$" if "_" in name else name


def draw_over_time(ax: Axes, curves: Sequence[RunCurve], variable: str, symbol: str) -> None:
    """Draw "force" or "X" of every run over time, with a cross where a run ended early."""
    factor, prefix = common(_without_rounding(curve.run, variable) for curve in curves)
    ax.set_ylabel(f"{symbol} ({prefix}{UNITS[variable]})")
    for curve in curves:
        times, values = curve.run.samples["time"], _without_rounding(curve.run, variable) * factor
        draw_curve(ax, curve, times, values)
        mark_early_end(ax, curve, times[-1], values[-1])
    ax.margins(y=0.08)
    fit_time(ax, curves)
    if variable == "X" and all(stays(curve.run) for curve in curves):
        say_only(ax, "at rest")


def draw_curve(ax: Axes, curve: RunCurve, time: Floats, values: Floats) -> None:
    """Draw values of a run over time in its style; swings too fast for the panel are a band.

    Too fast for the narrow lines, whatever the width of this one: equal motions look alike.
    """
    line = draw_line(ax, time, values, curve.color, NARROW)
    line.set(**{name: curve.look[name] for name in ("linestyle", "linewidth", "zorder")})


def fit_time(ax: Axes, curves: Sequence[RunCurve]) -> None:
    """Fit the axis of time to all runs: some may have ended early."""
    ends = [curve.run.samples["time"][[0, -1]] for curve in curves]
    if np.ptp(ends) > 0.0:
        ax.set_xlim(np.min(ends), np.max(ends))


def _without_rounding(run: Trajectory, variable: str) -> Floats:
    """Return force or position of a run, this without rounding errors where the mass rests."""
    if variable == "force":
        return cell_force(run)
    values = run.samples[variable]
    return np.zeros(len(values)) if stays(run) else values


def mark_early_end(ax: Axes, curve: RunCurve, x: float, y: float) -> None:
    """Mark the last point of a run that did not reach its duration."""
    if not curve.run.status.ok:
        ax.plot(x, y, "x", color=curve.color, markersize=5, markeredgewidth=1.2, zorder=4)
