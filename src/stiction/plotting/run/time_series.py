"""Quantities of a run over time, one function for each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import StepPatch
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike

from stiction.analysis.motion.rest import stuck_until
from stiction.analysis.signals.reversals import standing_out, taken_out
from stiction.analysis.signals.turning_points import COUNTS, as_counts
from stiction.analysis.slip import Slip, averaged_slip
from stiction.arrays import TINY, Floats, Indices
from stiction.plotting.page.parameter import label_decades
from stiction.plotting.page.style import BLACK, BLUE, GREEN, GREY, PURPLE, RED
from stiction.text.quantity_text import metric_prefix, percent
from stiction.trajectory import Trajectory

FEW = 50  # so few samples are drawn as points: the motion between them is unknown
PARTS = 500  # of the time: finer than a printed line shows
BINS = 1500  # more than a printed line has dots
LINES = 3.0  # widths of a line in a period: fewer leave next to no paper between its two strokes
TURNS = 6  # at least, of an oscillation: three periods
PAUSE, PAUSES = 3.0, 0.5  # times the median gap between turns, and the share of such in bursts
LONGER = 1.2  # times as long as they are, periods must fit into an oscillation: theirs differ
THIN = 5e-3  # of a panel's height: a smaller range looks like a line
RANGE = 1.5  # periods in which extremes are sought: they differ in length
MEAN = 4.0  # periods of a mean; two are the least whose weight cancels them
LARGER = 3.0  # times the median swing: larger ones are not noise, but another oscillation
APART = 15.0  # times a period: a mean over `MEAN` periods keeps 0.95 of an oscillation as slow
ALL_ALONG = 0.7  # of the time of an oscillation, noise on it is
BURSTS = 1.5  # times the gap between turns: larger swings that are as fast are bursts and spikes
SMOOTH = 13  # least bins of a mean, two of them with weight zero: one may hold a period and a half
POINT = 72.0  # pt in an inch
EDGE = 0.3  # pt, of the outline of a range: pale colours look alike in print
BAND = 0.3  # opacity of the range
HARDLY = 1.0  # %, of the time stuck: less is hardly seen
DEEPEST = 1e-6  # of the drive's speed: slower motion counts as rest
LEAST = 1e-9  # of the drive's speed, or of its path: smaller values are rounding
CONSTANT = 1e-9  # of a quantity: a smaller range is rounding
STILL = 1.0  # deg: least range of the axis of an angle


def envelope(time: ArrayLike, values: ArrayLike, bins: int = BINS) -> tuple[Floats, Floats]:
    """Thin out a long series without a visible change: keep the extremes of `bins` bins.

    Parameters
    ----------
    time, values : array
        (n,); NaN values leave gaps only where a whole bin lacks a value.
    bins : int
        How many.

    Returns
    -------
    time, values : ndarray
        (2 bins,), or what was given if that is not longer.
    """
    t, v = np.asarray(time, dtype=np.float64), np.asarray(values, dtype=np.float64)
    if len(t) <= 2 * bins:
        return t, v
    starts = _bin_starts(len(t), bins)
    middle = 0.5 * (t[starts] + t[np.r_[starts[1:], len(t)] - 1])
    low, high = np.fmin.reduceat(v, starts), np.fmax.reduceat(v, starts)
    return np.repeat(middle, 2), np.column_stack([low, high]).ravel()


class Oscillation(NamedTuple):
    """An oscillation: the samples from its first turn to its last, and its mean period in s.

    An oscillation that begins or ends with the record has the samples beyond these turns, too.
    """

    samples: slice
    period: float


def oscillations(time: Floats, values: Floats, longest: float, least: float) -> list[Oscillation]:
    """Find the oscillations with short periods.

    Parameters
    ----------
    time, values : ndarray
        (n,); NaN values are not turns.
    longest : float
        Period of the slowest of them, s, by the mean over time, and time between two turns that
        ends one.
    least : float
        Height of a turn; smaller ones do not count.
    """
    known = np.flatnonzero(np.isfinite(values))
    height = np.ptp(values[known]) if len(known) else 0.0
    if not 0.0 < least < height:
        return []
    points, _ = taken_out(as_counts(values[known]), COUNTS * least / height)
    first, *_, last = points = known[points]
    turns, found = points[1:-1], []
    for group in np.split(turns, np.flatnonzero(np.diff(time[turns]) > longest) + 1):
        group = visible_turns(time, values, turns, group)
        gaps = np.diff(time[group])
        if len(group) < TURNS or gaps[gaps > PAUSE * np.median(gaps)].sum() > PAUSES * gaps.sum():
            continue
        periods = time[group[2:]] - time[group[:-2]]
        # that at any time, not of any turn: the turns of a burst do not make up for a long pause
        period, lasts = np.average(periods, weights=periods), time[group[-1]] - time[group[0]]
        if period <= longest and (TURNS - 1) * period <= LONGER * 2.0 * lasts:
            begins = time[group[0]] - time[first] <= 1.5 * gaps[0]
            goes_on = time[last] - time[group[-1]] <= 1.5 * gaps[-1]
            start, end = first if begins else group[0], last if goes_on else group[-1]
            found.append(Oscillation(slice(start, end + 1), 2.0 * gaps.mean()))
    return found


def visible_turns(time: Floats, values: Floats, turns: Indices, group: Indices) -> Indices:
    """Leave out turns that are noise on an oscillation which a mean over their periods would alter.

    The mean of a few noise periods takes away part of an oscillation that is hardly slower, and
    more of it where the noise is slower: what is left beats.

    Parameters
    ----------
    time, values : ndarray
        (n,).
    turns, group : ndarray
        Indices of all turns, and of those that are looked at, which follow one another.

    Returns
    -------
    ndarray
        Those of the slower oscillation, or `group`.
    """
    while len(group) >= TURNS:
        gaps, least = np.diff(time[group]), LARGER * np.median(np.abs(np.diff(values[group])))
        beside = APART * gaps.mean()
        ends = time[group[0]] - beside, time[group[-1]] + beside
        near = turns[slice(*np.searchsorted(time[turns], ends))]
        counts, height = as_counts(values[near]), COUNTS * least / np.ptp(values[near])
        larger = near[standing_out(counts, height, np.inf)]
        slower = np.diff(time[larger])
        if not len(slower) or np.quantile(slower, 0.25) < BURSTS * np.median(gaps):
            break
        inside = larger[(larger >= group[0]) & (larger <= group[-1])]
        lasts = np.ptp(time[inside]) if len(inside) else 0.0  # of a growing one, only the end is
        if slower.mean() > beside or lasts < ALL_ALONG * np.ptp(time[group]):
            break
        group = inside
    return group


def draw_line(
    ax: Axes,
    time: ArrayLike,
    values: ArrayLike,
    color: str = BLACK,
    width: float = 0.7,
    window: tuple[float, float] | None = None,
) -> Line2D:
    """Draw values over time (s), thinned out by `envelope`.

    Where oscillations are too fast for a line of this width in this panel, the line is their mean,
    and a pale band their range.

    Parameters
    ----------
    ax : Axes
        Drawn on, in a figure that has its size.
    time, values : array
        (n,).
    color : str
        Of the line and the band.
    width : float
        Of the line, pt.
    window : tuple of float, optional
        Time and range that the panel shows, by default those of the values.
    """
    times, shown = np.asarray(time, dtype=np.float64), np.asarray(values, dtype=np.float64)
    if len(times) > FEW:
        height = np.fmax.reduce(shown) - np.fmin.reduce(shown)
        span, height = window or (times[-1] - times[0], height)
        across = POINT * ax.get_window_extent().width / ax.figure.get_dpi()
        longest = LINES * width / across * span
        found = oscillations(times, shown, longest, THIN * height)
        if found:
            shown = _draw_range(ax, times, shown, found, color)
    (line,) = ax.plot(*envelope(times, shown), color=color, linewidth=width)
    if len(times) <= FEW:
        line.set(linestyle="none", marker="o", markersize=2.5, clip_on=False, zorder=3)
    if times[-1] > times[0]:
        ax.set_xlim(times[0], times[-1])
    return line


def _draw_range(
    ax: Axes, time: Floats, values: Floats, found: list[Oscillation], color: str
) -> Floats:
    """Draw the range of oscillations as a band; return the values with their mean in its place."""
    bins = min(BINS, len(time) // 2)
    starts = _bin_starts(len(time), bins)
    step = (time[-1] - time[0]) / bins
    low, high, shown = np.full(bins, np.nan), np.full(bins, np.nan), values.copy()
    for samples, period in found:
        first, last = np.searchsorted(starts, (samples.start, samples.stop - 1), side="right") - 1
        within = slice(first, last + 1)
        inner = np.maximum(starts[within] - samples.start, 0)
        low[within], high[within], mean = _smooth(values[samples], inner, period / step)
        shown[samples] = np.repeat(mean, np.diff(inner, append=samples.stop - samples.start))
    middle = 0.5 * (time[starts] + time[np.r_[starts[1:], len(time)] - 1])
    band = ax.fill_between(middle, low, high, color=color, linewidth=EDGE)
    band.set_facecolor((color, BAND))
    return shown


def _smooth(values: Floats, starts: Indices, period: float) -> tuple[Floats, ...]:
    """Return low, high and mean of periods around each bin of an oscillation; `period` in bins."""
    known = np.isfinite(values)
    half = int(np.ceil(RANGE * period)) // 2
    low, high = (
        _extremes(np.where(known, values, none), starts, half, extreme, none)
        for extreme, none in ((np.fmin, np.inf), (np.fmax, -np.inf))
    )
    weight = np.hanning(max(SMOOTH, round(MEAN * period) // 2 * 2 + 3))
    total, count = (
        np.convolve(np.add.reduceat(each, starts), weight)[len(weight) // 2 :][: len(starts)]
        for each in (np.where(known, values, 0.0), known.astype(np.float64))
    )
    return low, high, total / np.maximum(count, TINY)


def _extremes(values: Floats, starts: Indices, half: int, extreme: np.ufunc, none: float) -> Floats:
    """Return the extreme of each bin and `half` as many to either side, as there are."""
    own = np.pad(extreme.reduceat(values, starts), half, constant_values=none)
    return np.asarray(extreme.reduce(sliding_window_view(own, 2 * half + 1), axis=1))


def _bin_starts(samples: int, bins: int) -> Indices:
    """Return the index of the first sample of each bin."""
    return np.linspace(0, samples, bins, endpoint=False).astype(np.intp)


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
    """Label a time axis, whose values are in s, in a suitable unit: s, ms, ..."""
    factor, prefix = metric_prefix(ax.get_xlim())
    factor, prefix = (factor, prefix) if factor > 1.0 else (1.0, "")
    ax.xaxis.set_major_formatter(FuncFormatter(lambda t, _: f"{factor * t:.10g}"))
    ax.set_xlabel(f"time $t$ ({prefix}s)")


def draw_spring_force(ax: Axes, run: Trajectory, axis: str) -> Line2D:
    """Draw the spring force along the principal axis ``"x"`` or ``"y"`` over time."""
    return draw_quantity(ax, run, f"spring_{axis}", rf"$k_{axis} u_{axis}$", RED)


def draw_friction(ax: Axes, run: Trajectory) -> Line2D:
    """Draw the magnitude of the friction force over time."""
    return draw_values(ax, run, _after_start(run, "friction"), "$F$", "N", PURPLE)


def _after_start(run: Trajectory, variable: str) -> Floats:
    """Return a variable without its first value, that of the release of the mass.

    There it moves with a millionth of the drive's speed, and friction is what it is in slip; it
    sticks, or creeps far slower, at once. Few samples, which are shown as such, keep it.
    """
    values = run.samples[variable].astype(np.float64)
    if len(values) > FEW:
        values[0] = np.nan
    return values


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
    return bool(way > 0.0 and np.ptp(run.samples["X"]) <= LEAST * way)


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
    if not largest > LEAST * fastest_drive(run):
        say_only(ax, "no slip")
        return draw_line(ax, run.samples["time"], np.zeros(len(speed)), GREEN)
    ax.set_yscale("log")
    least = 0.0 if hasattr(run.slider.law, "grain") else 1e-7 * largest
    if len(speed) <= FEW:
        shown = np.where(speed > least, speed, np.nan)
        return draw_line(ax, run.samples["time"], shown, GREEN)
    slip = average_slip(run)
    mean = np.where(slip.mean > least, slip.mean, np.nan)
    band = ax.fill_between(slip.time, mean, slip.high, color=GREEN, linewidth=EDGE)
    band.set_facecolor((GREEN, BAND))  # the edge shows slips shorter than a dot
    line = draw_line(ax, slip.time, mean, GREEN)
    set_speed_limits(ax, [(slip, fastest_drive(run))])
    return line


def slipping(slip: Slip, drive: float) -> Floats | None:
    """Return the mean speeds of slip, without the moments beside a rest; None if nothing slips.

    How slow the last sample before a rest is depends on when it is taken.

    Parameters
    ----------
    slip : Slip
        Of a run.
    drive : float
        Largest speed of its drive, m/s.
    """
    moves = np.isfinite(slip.mean) & (slip.mean > DEEPEST * drive)
    if not moves[1:].any() or not np.fmax.reduce(slip.high[1:]) > LEAST * drive:
        return None  # but for the release of the mass
    moving = moves & (slip.rest < 0.5)
    rests = np.pad(slip.rest >= 1.0, 1, mode="edge")
    inner = moving & ~(rests[:-2] | rests[2:])
    return next(slip.mean[some] for some in (inner, moving, moves) if some.any())


def set_speed_limits(ax: Axes, slips: Sequence[tuple[Slip, float]]) -> bool:
    """Fit a logarithmic axis to slip speeds, ignoring rest and the moments beside it.

    Return whether anything slips: nothing is done otherwise.

    Parameters
    ----------
    ax : Axes
        The axes.
    slips : sequence of (Slip, float)
        Of each run, with the largest speed of its drive, m/s.
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
    """Average slip over a 500th of the time, or less to resolve a rapid slip."""
    times, slider = run.samples["time"], run.slider
    rapid = 0.5 / slider.natural_frequencies[0]
    parts = np.clip(5 * (times[-1] - times[0]) / rapid, PARTS, 20 * PARTS)
    return averaged_slip(run, int(parts))


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
