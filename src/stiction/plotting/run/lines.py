"""Lines of a run: long series thinned out, and oscillations too fast for print drawn as a band."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike, NDArray

from stiction.analysis.signals.reversals import remove_reversals, standing_out
from stiction.analysis.signals.turning_points import COUNTS, as_counts
from stiction.arrays import TINY, Floats, Indices
from stiction.plotting.page.style import BLACK

FEW_SAMPLES = 50  # so few samples are drawn as points: the motion between them is unknown
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
FAR = 0.7  # swings between means over several periods and over one, as in a slip
BESIDE, MARGIN = 7, 3  # swings whose median is that of an oscillation; bins beside a slip
POINT = 72.0  # pt in an inch
EDGE = 0.3  # pt, of the outline of a range: pale colours look alike in print
BAND = 0.3  # opacity of the range


def envelope(time: ArrayLike, values: ArrayLike, bins: int = BINS) -> tuple[Floats, Floats]:
    """Thin out a long series without a visible change: keep the extremes of `bins` bins.

    NaN values leave gaps only where a whole bin lacks a value. A series that is no longer than (2
    bins,) stays as it is.
    """
    t, v = np.asarray(time, dtype=np.float64), np.asarray(values, dtype=np.float64)
    if len(t) <= 2 * bins:
        return t, v
    starts = _bin_starts(len(t), bins)
    middle = 0.5 * (t[starts] + t[np.r_[starts[1:], len(t)] - 1])
    low, high = np.fmin.reduceat(v, starts), np.fmax.reduceat(v, starts)
    return np.repeat(middle, 2), np.column_stack([low, high]).ravel()


class Oscillation(NamedTuple):
    """An oscillation: the samples from its first turn to its last, its mean period in s, its turns.

    An oscillation that begins or ends with the record has the samples beyond these turns, too.
    """

    samples: slice
    period: float
    turns: Indices


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
    points, _ = remove_reversals(as_counts(values[known]), COUNTS * least / height)
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
            found.append(Oscillation(slice(start, end + 1), 2.0 * gaps.mean(), group))
    return found


def visible_turns(time: Floats, values: Floats, turns: Indices, group: Indices) -> Indices:
    """Leave out turns that are noise on an oscillation which a mean over their periods would alter.

    The mean of a few noise periods takes away part of an oscillation that is hardly slower, and
    more of it where the noise is slower: what is left beats.

    Of all `turns`, a `group` of which is looked at, those of the slower oscillation are returned,
    or the group.
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
    thin: float = THIN,
) -> Line2D:
    """Draw values over time (s), thinned out by `envelope`.

    Where oscillations are too fast for a line of this width in this panel, the line is their mean,
    and a pale band their range; not of those lower than a share `thin` of the panel, which are
    drawn as they are.

    The `window` is the time and range that the panel shows, by default those of the values; the
    figure has its size already.
    """
    times, shown = np.asarray(time, dtype=np.float64), np.asarray(values, dtype=np.float64)
    if len(times) > FEW_SAMPLES:
        height = np.fmax.reduce(shown) - np.fmin.reduce(shown)
        span, height = window or (times[-1] - times[0], height)
        across = POINT * ax.get_window_extent().width / ax.figure.get_dpi()
        longest = LINES * width / across * span
        found = oscillations(times, shown, longest, thin * height)
        if found:
            shown = _draw_range(ax, times, shown, found, color)
    (line,) = ax.plot(*envelope(times, shown), color=color, linewidth=width)
    if len(times) <= FEW_SAMPLES:
        line.set(linestyle="none", marker="o", markersize=2.5, clip_on=False, zorder=3)
    if times[-1] > times[0]:
        ax.set_xlim(times[0], times[-1])
    return line


def _draw_range(
    ax: Axes, time: Floats, values: Floats, found: list[Oscillation], color: str
) -> Floats:
    """Draw the range of oscillations as a band; return the values with their mean in its place."""
    starts, low, high, shown = _ranges(time, values, found, min(BINS, len(time) // 2))
    middle = 0.5 * (time[starts] + time[np.r_[starts[1:], len(time)] - 1])
    if np.isfinite(low).any():  # else all of it was part of quick slips
        band = ax.fill_between(middle, low, high, color=color, linewidth=EDGE)
        band.set_facecolor((color, BAND))
    return shown


def mean_course(
    time: Floats, speeds: Floats, highest: Floats, longest: float
) -> tuple[Floats, Floats]:
    """Return mean and highest speed of each fast oscillation that a logarithmic axis shows.

    Elsewhere, as in a slip, they stay what they are. The slowest of the oscillations has a period
    of `longest`, s.
    """
    decades = np.log10(np.where(speeds > 0.0, speeds, np.nan))
    height = np.fmax.reduce(decades) - np.fmin.reduce(decades)
    found = oscillations(time, decades, longest, THIN * height)
    if not found:
        return speeds, highest
    starts, low, _, shown = _ranges(time, speeds, found, len(time) // 2)
    _, _, high, _ = _ranges(time, highest, found, len(time) // 2)
    low, high = (np.repeat(each, np.diff(starts, append=len(time))) for each in (low, high))
    return np.where(np.isfinite(low), shown, speeds), np.fmax(highest, high)


def _ranges(
    time: Floats, values: Floats, found: list[Oscillation], bins: int
) -> tuple[Indices, Floats, Floats, Floats]:
    """Return first samples of bins, low and high of oscillations there, values with their mean.

    Low and high are NaN where there is no oscillation, and in a slip.
    """
    starts = _bin_starts(len(time), bins)
    step = (time[-1] - time[0]) / bins
    low, high, shown = np.full(bins, np.nan), np.full(bins, np.nan), values.copy()
    for samples, period, turns in found:
        first, last = np.searchsorted(starts, (samples.start, samples.stop - 1), side="right") - 1
        within = slice(first, last + 1)
        inner = np.maximum(starts[within] - samples.start, 0)
        low[within], high[within], mean = _smooth(values[samples], inner, period / step)
        short, apart = _course(values[samples], inner, mean, turns - samples.start, period / step)
        low[within][apart] = high[within][apart] = np.nan
        mean = np.where(apart, short, mean)
        shown[samples] = np.repeat(mean, np.diff(inner, append=samples.stop - samples.start))
    return starts, low, high, shown


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


def _course(
    values: Floats, starts: Indices, mean: Floats, turns: Indices, period: float
) -> tuple[Floats, NDArray[np.bool_]]:
    """Return the mean over one period, and where that over several is far from it, as in a slip.

    A slip is as fast as the oscillation, and would be drawn as a slope many periods long.

    Bins begin at `starts`, and have a `mean` over periods and a `period` in bins.
    """
    from scipy.ndimage import (  # type: ignore[attr-defined]
        maximum_filter1d,
        median_filter,
        uniform_filter1d,
    )

    known = np.isfinite(values)
    count = np.maximum(np.add.reduceat(known.astype(np.float64), starts), TINY)
    own = np.add.reduceat(np.where(known, values, 0.0), starts) / count
    short = uniform_filter1d(own, max(round(period), 1), mode="nearest")
    swing = median_filter(np.abs(np.diff(values[turns])), BESIDE, mode="mirror")  # no slip is one
    far = np.abs(short - mean) > FAR * np.interp(starts, turns[1:], swing)
    return short, np.asarray(maximum_filter1d(far, 1 + 2 * MARGIN))


def _extremes(values: Floats, starts: Indices, half: int, extreme: np.ufunc, none: float) -> Floats:
    """Return the extreme of each bin and `half` as many to either side, as there are."""
    own = np.pad(extreme.reduceat(values, starts), half, constant_values=none)
    return np.asarray(extreme.reduce(sliding_window_view(own, 2 * half + 1), axis=1))


def _bin_starts(samples: int, bins: int) -> Indices:
    """Return the index of the first sample of each bin."""
    return np.linspace(0, samples, bins, endpoint=False).astype(np.intp)
