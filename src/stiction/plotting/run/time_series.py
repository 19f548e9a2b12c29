"""Quantities of a run over time, one function for each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import StepPatch
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator
from numpy.typing import ArrayLike

from stiction.analysis.motion.rest import stuck_until
from stiction.analysis.slip import Slip, averaged_slip
from stiction.arrays import Floats
from stiction.plotting.page.parameter import label_decades
from stiction.plotting.page.style import BLACK, BLUE, GREEN, GREY, PURPLE, RED
from stiction.plotting.run.lines import BAND, EDGE, FEW_SAMPLES, draw_line, mean_course
from stiction.result.table import fastest_slip
from stiction.text.quantity.prefix import YEAR, metric_prefix
from stiction.text.quantity.wording import percent
from stiction.trajectory import Trajectory

PARTS_OF_TIME = 500  # of the time: finer than a printed line shows
HARDLY = 1.0  # %, of the time stuck: less is hardly seen
DEEPEST = 1e-6  # of the drive's speed: slower motion counts as rest
LEAST_MOTION = 1e-9  # of the drive's speed, or of its path: smaller values are rounding
CONSTANT = 1e-9  # of a quantity: a smaller range is rounding
STILL = 1.0  # deg: least range of the axis of an angle
UNSEEN = "faster between samples"


def draw_quantity(
    ax: Axes, run: Trajectory, variable: str, symbol: str, color: str = BLACK
) -> Line2D:
    """Draw a variable of the run over time, in a suitable unit."""
    column = run.samples.columns[variable]
    return draw_values(ax, run, column.values, symbol, column.attributes["units"], color)


def draw_values(
    ax: Axes, run: Trajectory, values: ArrayLike, symbol: str, unit: str, color: str = BLACK
) -> Line2D:
    """Draw values over the run's time, in a suitable multiple of their unit."""
    array = np.asarray(values, dtype=np.float64)
    factor, prefix = metric_prefix(array)
    ax.set_ylabel(f"{symbol} ({prefix}{unit})")
    low, high = (float(each.reduce(array, initial=np.nan)) for each in (np.fmin, np.fmax))
    if high - low < CONSTANT * max(high, -low):
        array = np.where(np.isfinite(array), 0.5 * (low + high), array)
    return draw_line(ax, run.samples["time"], array * factor, color)


def imposed_quantities(run: Trajectory) -> list[tuple[str, Floats, str, str]]:
    """Return the varying imposed quantities: name, values, symbol, unit.

    Drive velocity along X and across it, and normal load.
    """
    names = (("drive_X", "$V$"), ("drive_Y", "$V_Y$"), ("normal_load", "$W$"))
    found = [(name, run.samples.columns[name], symbol) for name, symbol in names]
    return [
        (name, each.values, symbol, each.attributes["units"])
        for name, each, symbol in found
        if np.ptp(each.values) > 0
    ]


def name_time(ax: Axes) -> None:
    """Label a time axis, whose values are in s, in a suitable unit: yr, s, ms, ..."""
    factor, prefix = metric_prefix(ax.get_xlim())
    factor, prefix = (factor, prefix) if factor > 1.0 else (1.0, "")
    ax.xaxis.set_major_formatter(FuncFormatter(lambda t, _: f"{factor * t:.10g}"))
    ax.set_xlabel(f"time $t$ ({prefix}s)")
    name_years(ax)


class WholeYears(MaxNLocator):
    """Ticks of an axis in s at round numbers of years."""

    def tick_values(self, vmin: float, vmax: float) -> Any:
        """Return the places of the ticks, s."""
        return YEAR * np.asarray(super().tick_values(vmin / YEAR, vmax / YEAR))


def name_years(ax: Axes) -> None:
    """Label a time axis, whose values are in s, in years if it is that long, as texts do."""
    if np.abs(ax.get_xlim()).max() >= YEAR:
        ax.xaxis.set_major_locator(WholeYears(nbins="auto", steps=[1, 2, 2.5, 5, 10]))
        ax.xaxis.set_major_formatter(FuncFormatter(lambda t, _: f"{t / YEAR:.10g}"))
        ax.set_xlabel("time $t$ (yr)")


def draw_spring_force(ax: Axes, run: Trajectory, axis: str) -> Line2D:
    """Draw the spring force along the principal axis ``"x"`` or ``"y"`` over time."""
    return draw_quantity(ax, run, f"spring_{axis}", rf"$k_{axis} u_{axis}$", RED)


def draw_friction(ax: Axes, run: Trajectory) -> Line2D:
    """Draw the magnitude of the friction force over time."""
    return draw_values(ax, run, _after_start(run, "friction"), "$F$", "N", PURPLE)


def _after_start(run: Trajectory, variable: str) -> Floats:
    """Return a variable without its first value, at the release of the mass.

    There it moves with a millionth of the drive's speed, and friction is what it is in slip; it
    sticks, or creeps far slower, at once. Few samples, which are shown as such, keep it.
    """
    values = run.samples[variable].astype(np.float64)
    if len(values) > FEW_SAMPLES:
        values[0] = np.nan
    return values


def friction_turns(run: Trajectory) -> bool:
    """Return whether the friction angle psi changes by more than its panel would show."""
    angles = cut_open(_after_start(run, "psi"))
    known = angles[np.isfinite(angles)]
    return len(known) > 0 and float(np.ptp(known)) > STILL


def draw_direction(ax: Axes, run: Trajectory) -> Line2D:
    """Draw the friction angle psi (deg) to the drive direction over time."""
    angles = cut_open(_after_start(run, "psi"))
    low, high = (float(each.reduce(angles, initial=np.nan)) for each in (np.fmin, np.fmax))
    steps = [1, 1.5, 3, 4.5, 9, 10] if high - low > 40.0 else [1, 2, 5, 10]  # 30, 45, 90 deg
    ax.yaxis.set_major_locator(MaxNLocator(nbins=4, steps=steps))
    ax.set_ylabel(r"$\psi$ (deg)")
    line = draw_line(ax, run.samples["time"], angles, PURPLE)
    if high - low < STILL:
        ax.set_ylim(low - STILL, high + STILL)
    return line


def cut_open(angles: ArrayLike) -> Floats:
    """Return angles (deg) on the turn that begins where the fewest of them lie.

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
    """Draw the position X along the drive direction over time, without rounding errors."""
    if not stays(run):
        return draw_quantity(ax, run, "X", "$X$", BLUE)
    line = draw_values(ax, run, np.zeros(len(run.samples["X"])), "$X$", "m", BLUE)
    say_only(ax, "at rest")
    return line


def stays(run: Trajectory) -> bool:
    """Return whether the mass stays where it is, but for rounding, while the drive moves."""
    way = fastest_drive(run) * float(np.ptp(run.samples["time"]))
    return bool(way > 0.0 and np.ptp(run.samples["X"]) <= LEAST_MOTION * way)


def fastest_drive(run: Trajectory) -> float:
    """Return the largest speed of the drive in a run, m/s."""
    return float(np.hypot(run.samples["drive_X"], run.samples["drive_Y"]).max())


def say_only(ax: Axes, text: str) -> None:
    """Write the content of a panel that has no scale."""
    ax.set_yticks([])
    ax.set_yticks([], minor=True)
    ax.text(0.5, 0.6, text, transform=ax.transAxes, ha="center", color=GREY, fontsize=7)


def draw_rate(ax: Axes, run: Trajectory, axis: str) -> Line2D:
    """Draw the elongation rate along the principal axis ``"x"`` or ``"y"`` over time."""
    return draw_quantity(ax, run, f"v_{axis}", rf"$v_{axis}$", RED)


def draw_slip_speed(ax: Axes, run: Trajectory) -> Line2D:
    """Draw the slip speed (m/s) over time on a logarithmic axis; gaps where it is zero.

    The line is the mean over short times, a pale band reaches to the maximum: where it comes to
    rest in each of many oscillations, how far it falls is not a speed of the system. Speeds below
    1e-7 of the largest are left out, so that a landing does not stretch the axis; of rate and
    state, under which nothing lands, none are. Where samples are too few for that, the line is the
    speed of the mean motion (`averaged_slip`).
    """
    speed = _after_start(run, "slip_speed")
    largest = np.fmax.reduce(speed, initial=0.0)
    ax.set_ylabel(r"$v_\mathrm{slip}$ (m/s)")
    if not largest > LEAST_MOTION * fastest_drive(run):
        say_only(ax, "no slip")
        return draw_line(ax, run.samples["time"], np.zeros(len(speed)), GREEN)
    ax.set_yscale("log")
    least = 0.0 if hasattr(run.slider.law, "grain") else 1e-7 * largest
    if len(speed) <= FEW_SAMPLES:
        shown = np.where(speed > least, speed, np.nan)
        return draw_line(ax, run.samples["time"], shown, GREEN)
    slip = average_slip(run)
    mean = np.where(slip.mean > least, slip.mean, np.nan)
    band = ax.fill_between(slip.time, mean, slip.high, color=GREEN, linewidth=EDGE)
    band.set_facecolor((GREEN, BAND))  # the edge shows slips shorter than a dot
    line = draw_line(ax, slip.time, mean, GREEN)
    set_speed_limits(ax, [(slip, fastest_drive(run))])
    if not fastest_slip(run.samples)[1]:
        ax.set_title(UNSEEN, loc="right", fontsize=7, color=GREY, pad=2.0)
    return line


def slipping(slip: Slip, drive: float) -> Floats | None:
    """Return the mean speeds of slip, without the moments beside a rest; None if nothing slips.

    How slow the last sample before a rest is depends on when it is taken. The largest speed of its
    `drive` is in m/s.
    """
    moves = np.isfinite(slip.mean) & (slip.mean > DEEPEST * drive)
    if not moves[1:].any() or not np.fmax.reduce(slip.high[1:]) > LEAST_MOTION * drive:
        return None  # but for the release of the mass
    moving = moves & (slip.rest < 0.5)
    rests = np.pad(slip.rest >= 1.0, 1, mode="edge")
    inner = moving & ~(rests[:-2] | rests[2:])
    return next(slip.mean[some] for some in (inner, moving, moves) if some.any())


def set_speed_limits(ax: Axes, slips: Sequence[tuple[Slip, float]]) -> bool:
    """Fit a logarithmic axis to slip speeds, ignoring rest and the moments beside it.

    Return whether anything slips: nothing is done otherwise. Each slip has the largest speed of its
    drive, m/s, beside it.
    """
    means = [each for each in (slipping(*of) for of in slips) if each is not None]
    if not means:
        return False
    top = max(float(np.fmax.reduce(slip.high)) for slip, _ in slips)
    bottom = min(float(each.min()) for each in means)
    decades = max(np.log10(top / bottom), 1.0)
    ax.set_ylim(bottom / 10 ** max(0.3, 0.05 * decades), top * 10 ** (0.05 * decades))
    ax.yaxis.set_major_locator(LogLocator(numticks=8))
    ax.yaxis.set_minor_locator(LogLocator(subs="all" if decades < 8 else (1.0,), numticks=99))
    label_decades(ax.yaxis, bottom, top)
    return True


def average_slip(run: Trajectory) -> Slip:
    """Average slip over a 500th of the time, or less to resolve a rapid slip.

    The mean of oscillations within the time of a slip is theirs as a whole: near slip they are
    slower than that average, and how far each falls is not a speed of the system.
    """
    times, slider = run.samples["time"], run.slider
    rapid = 0.5 / slider.natural_frequencies[0]
    parts = np.clip(5 * (times[-1] - times[0]) / rapid, PARTS_OF_TIME, 20 * PARTS_OF_TIME)
    slip = averaged_slip(run, int(parts))
    mean, high = mean_course(slip.time, slip.mean, slip.high, rapid)
    return slip._replace(mean=mean, high=high)


def draw_time_stuck(ax: Axes, run: Trajectory, bins: int = 300) -> StepPatch:
    """Draw the share of time (%) spent at zero slip, from every stick interval of the run.

    Stick intervals can be far shorter than the sample interval and number thousands; their share
    in each of `bins` bins shows them all.
    """
    times = run.samples["time"]
    edges = np.linspace(times[0], max(times[-1], np.nextafter(times[0], np.inf)), bins + 1)
    widths = np.diff(edges)  # zero in a run of one sample
    share = 100.0 * np.diff(stuck_until(edges, run.stick_intervals)) / np.where(widths, widths, 1.0)
    ax.set_ylabel("stuck (%)")
    whole = float(share.mean())
    if whole < HARDLY:
        said = f"stuck for {percent(0.01 * whole)} of the time" if whole else "no stick"
        ax.text(0.5, 0.4, said, transform=ax.transAxes, ha="center", color=GREY, fontsize=7)
    ax.set_ylim(0, 105)
    return ax.stairs(share, edges, fill=True, color=GREY)
