"""The change from loading to creep, or to sliding, in a rise of the force."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.signals.digitised import fall_by_rounding, resolution
from stiction.analysis.signals.peak_refinement import Fits, Pieces, fit_pieces
from stiction.arrays import TINY, Floats, Indices
from stiction.recording.noise import dither_remainder, white_noise

STRAIGHT_PART = (0.1, 0.5)  # part of the rise that is straight: after the swing, before the creep
# A loading is not straight if its line comes from so far above the trough, or if it deviates so
# far from it, over what it gains; and by more than so many standard deviations of noise, which
# makes a trough so low: it is the lowest of some samples
LIFTS, STEPS, NOISE = 0.05, 0.03, 3.0
# Times as much bends a whole rise: less may be a drive whose velocity varies, or a filter's swing
GROSSLY = 5.0
# Relative error of rates by a line through a single step: in 420 records of 2 to 20 steps a drop
# their median is off by 0.10 at most, as a standard error
ROUNDED = 0.1
FEWEST = 4  # samples between first and last of a straight part, of which half as many are enough
# A rise that rings falls from the top of its first swing, by so much of the height of that top over
# the line from trough to peak; and it goes on more slowly than the flank of that swing, as it does
# not after a small slip
BACK, FLANK = 0.4, 1.5
RANGE = 10.0  # standard deviations of noise: of a million samples


def loaded_until(
    time: Floats, force: Floats, start: Floats, start_force: Floats, peak_time: Floats
) -> Floats:
    """Return the time until which each rise counts as loading: half of it is straight.

    A mass may slide, or creep, for most of a rise. Then the line through its first half does not
    come from the trough by far, or is none: half as long a rise is looked at, and so on until it is
    straight, as long as it has samples; the straightest counts. Where the force rings after a slip,
    that would be the flank of a swing: there half of the rise counts after all.
    """
    noise, step = white_noise(force), resolution(force)
    hidden = NOISE * noise + step
    until, rises = peak_time.copy(), np.arange(len(start))
    straightest, ends = np.full(len(start), np.inf), peak_time.copy()
    while len(rises):
        begin, end = _window(time, start[rises], ends[rises])
        fit = fit_pieces(time, force, begin, end, 1)
        level, slope = fit.coefficients[:, 0], fit.coefficients[:, 1] / fit.half
        lifted = level - slope * (fit.middle - start[rises]) - start_force[rises]
        away = _deviation(fit, time, force, begin, end)
        gained = np.maximum(slope * (time[end] - start[rises]), TINY)
        bent = np.maximum((lifted - hidden) / LIFTS, (away - hidden) / STEPS) / gained
        bent[(ends[rises] == peak_time[rises]) & (bent < GROSSLY)] = 0.0
        better = bent < straightest[rises]
        straightest[rises[better]], until[rises[better]] = bent[better], ends[rises[better]]
        rises = rises[(bent > 1.0) & (end - begin >= FEWEST)]
        ends[rises] = 0.5 * (start[rises] + ends[rises])
    shorter = until < peak_time
    its = start[shorter], until[shorter], peak_time[shorter]
    least = RANGE * noise + fall_by_rounding(force)
    until[shorter] = np.where(are_flanks(time, force, *its, least), its[2], its[1])
    return until


def _deviation(fit: Fits, time: Floats, force: Floats, begin: Indices, end: Indices) -> Floats:
    """Return the root mean square deviation of a force from the line of each piece, N."""
    at, piece, first = Pieces.between(begin, end)
    x = (time[at] - fit.middle[piece]) / fit.half[piece]
    away = force[at] - fit.coefficients[piece, 0] - fit.coefficients[piece, 1] * x
    return np.asarray(np.sqrt(np.add.reduceat(away**2, first) / (end - begin + 1)))


def are_flanks(
    time: Floats,
    force: Floats,
    start: Floats,
    until: Floats,
    peak_time: Floats,
    hidden: Floats | float,
) -> NDArray[np.bool_]:
    """Return which rises begin, until a time, with the flank of a swing, as a load cell rings.

    The mean of such swings is about zero over the whole rise. Noise hides a force of `hidden` (N).
    """
    first, last = rise_ends(time, start, peak_time)
    late = late_line(time, force, first, last, 0.5 * (until + peak_time))
    found = loading_rate(time, force, start, until) > FLANK * late.coefficients[:, 1] / late.half
    if found.any():
        first, last = first[found], last[found]
        tops, leads = tops_of_rises(time, force, first, last)
        its = Pieces.between(tops, last)
        falls = force[tops] - np.minimum.reduceat(force[its.at], its.begins)
        least = np.broadcast_to(hidden, len(start))[found]
        found[found] = falls > np.maximum(BACK * leads, least)
    return found


def tops_of_rises(
    time: Floats, force: Floats, first: Indices, last: Indices
) -> tuple[Indices, Floats]:
    """Return the sample at which each rise is farthest above the line to its end, and how far."""
    at, piece, begins = its = Pieces.between(first, last)
    slope = (force[last] - force[first]) / (time[last] - time[first])
    line = slope[piece] * (time[at] - time[first][piece]) + force[first][piece]
    lead = np.where(at == last[piece], 0.0, force[at] - line)
    farthest = np.maximum.reduceat(lead, begins)
    return its.first(lead == farthest[piece]), farthest


def rise_ends(time: Floats, start: Floats, peak_time: Floats) -> tuple[Indices, Indices]:
    """Return first and last sample of each rise."""
    first, last = (samples_from(time, each) for each in (start, peak_time))
    last = np.clip(last, 2, len(time) - 1)
    return np.minimum(first, last - 2), last


def late_line(time: Floats, force: Floats, first: Indices, last: Indices, begin: Floats) -> Fits:
    """Return the line through each rise from a time on."""
    middle = np.maximum(np.minimum(samples_from(time, begin), last - 1), first)
    return fit_pieces(time, force, middle, last, 1)


def loading_rate(time: Floats, force: Floats, start: Floats, until: Floats) -> Floats:
    """Return the rate of each rise in its straight part."""
    fit = fit_pieces(time, force, *_window(time, start, until), 1)
    slope: Floats = fit.coefficients[:, 1] / fit.half
    return slope


def late_rate(time: Floats, force: Floats, start: Floats, peak_time: Floats) -> Floats:
    """Return the rate of each rise in its second half."""
    fit = late_line(time, force, *rise_ends(time, start, peak_time), 0.5 * (start + peak_time))
    rate: Floats = fit.coefficients[:, 1] / fit.half
    return rate


def rounding_of_rates(force: Floats, rise: float) -> float:
    """Return the relative error that the steps of a converter make in all rates of loading alike.

    Each rise begins at a trough, which is rounded to the same steps as what follows it: the line
    through few of them is too steep, or not steep enough, in most rises. Noise breaks that up.
    Rises are usually as high as `rise`, N.
    """
    step = resolution(force)
    if not step or rise <= 0.0:
        return 0.0
    steps = (STRAIGHT_PART[1] - STRAIGHT_PART[0]) * rise / step
    return float(ROUNDED * dither_remainder(force, step) * steps**-1.5)


def _window(time: Floats, start: Floats, until: Floats) -> tuple[Indices, Indices]:
    """Return first and last sample of the straight part of each rise."""
    begin, end = (samples_from(time, start + part * (until - start)) for part in STRAIGHT_PART)
    begin = np.minimum(begin, len(time) - 2)
    return begin, np.maximum(end, begin + 1)


def samples_from(time: Floats, begin: Floats) -> Indices:
    """Return the first sample at or after each time, within rounding."""
    place = np.interp(begin, time, np.arange(len(time), dtype=np.float64))
    return np.ceil(place - 1e-3).astype(np.intp)
