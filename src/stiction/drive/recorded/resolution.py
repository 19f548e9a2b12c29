"""The resolution of a table's rows: noise, and jumps from row to row.

Each value is compared with the cubic through its four neighbours (M80). Where rows follow a smooth
motion, the deviations of neighbours are alike; those of noise have opposite signs.
"""

from __future__ import annotations

from math import isfinite, nan, sqrt
from typing import NamedTuple

import numpy as np

from stiction.arrays import NORMAL_MEDIAN, Floats

FEWEST_JUDGED_ROWS = 8  # rows: fewer are taken as they are
NOTICED = 1e-3  # of the largest value: smaller deviations, as of rounded digits, have no effect
# of neighbours' deviations: 0 is that of a wave with four rows to its period, white noise has -0.8
LEAST_CORRELATION = 0.0
# standard deviation of a cubic spline's slope over that of its values' noise, times the row spacing
SLOPE_NOISE = 3.0 * sqrt(2.0 / sqrt(3.0) - 1.0)
ISOLATED = 0.2  # typical deviation over the root of the mean square: below, few rows have it all
FAR = 6.0  # typical deviations: beyond it is a jump
BINS, ABOVE, MARGIN = 9, 5.0, 2.0  # of the spectrum: smoothed over, over the noise, of a cut-off


class Roughness(NamedTuple):
    """Unresolved parts of a table: the standard deviation of noise, or the rows of single jumps.

    `noise` is in the unit of the value that counts, and `share` is its share of the largest one;
    `cut_off` (Hz) is where the spectrum drowns in it, NaN if that is nowhere.
    """

    noise: float
    share: float
    jumps: list[int]
    cut_off: float
    rate: float


def roughness(time: Floats, values: Floats, largest: float, integrated: bool) -> Roughness | None:
    """Return the unresolved parts of a table; None if its rows resolve everything.

    Parameters
    ----------
    time, values : ndarray
        (n,), s and SI.
    largest : float
        The largest magnitude of the value that counts: of the velocity if positions are given.
    integrated : bool
        Whether the values are positions, whose slope counts.
    """
    if len(time) < FEWEST_JUDGED_ROWS or largest == 0.0:
        return None
    off = deviations(time, values)
    square = float(np.mean(off * off))
    spacing = float(np.median(np.diff(time)))
    effect = SLOPE_NOISE / spacing if integrated else 1.0
    share = effect * sqrt(square) / largest
    if share <= NOTICED or correlation(off) >= LEAST_CORRELATION:
        return None
    typical = float(np.median(np.abs(off))) / NORMAL_MEDIAN
    jumps: list[int] = []
    if typical < ISOLATED * sqrt(square):
        least = max(FAR * typical, sqrt(square))
        far = np.flatnonzero(np.abs(off) > least) + 2
        beside = np.split(far, np.flatnonzero(np.diff(far) > 2) + 1)  # each shows in four rows
        jumps = [int(np.mean(each)) for each in beside if len(each)]
    even = np.ptp(np.diff(time)) < 0.1 * spacing
    cut = cut_off(values, 1.0 / spacing, square) if even and not jumps else nan
    return Roughness(effect * sqrt(square), share, jumps, cut, 1.0 / spacing)


def deviations(time: Floats, values: Floats) -> Floats:
    """Return by how much each value deviates from its neighbours (M80): the first and last two not.

    White noise has the same standard deviation here as in the values, wherever the rows lie.
    """
    near = [time[i : len(time) - 4 + i] - time[2:-2] for i in (0, 1, 3, 4)]
    off, square = values[2:-2].copy(), np.ones(len(time) - 4)
    for i, j in enumerate((0, 1, 3, 4)):
        others = [x for n, x in enumerate(near) if n != i]
        weight = np.prod([x / (x - near[i]) for x in others], axis=0)
        off -= weight * values[j : len(time) - 4 + j]
        square += weight * weight
    found: Floats = off / np.sqrt(square)
    return found


def correlation(off: Floats) -> float:
    """Return the correlation of neighbouring deviations: 1 - R/2, R their mean squared change."""
    changes = np.diff(off)
    return 1.0 - 0.5 * float(np.mean(changes * changes) / np.mean(off * off))


def cut_off(values: Floats, rate: float, square: float) -> float:
    """Return twice the highest frequency (Hz) that stands out of white noise; NaN if too high.

    `square` is the variance of the noise. A filter needs a quarter of the sampling rate above it.
    """
    window = np.hanning(len(values) + 2)[1:-1]
    line = np.polynomial.Polynomial.fit(np.arange(len(values)), values, 1)
    left = (values - line(np.arange(len(values)))) * window
    power = np.abs(np.fft.rfft(left)) ** 2 / np.sum(window * window)
    mean = np.convolve(power, np.ones(BINS) / BINS, mode="same")
    out = np.flatnonzero(mean > ABOVE * square)
    highest = MARGIN * (int(out[-1]) if len(out) else 0) * rate / len(values)
    least = 10.0 * rate / len(values)
    return max(highest, least) if max(highest, least) < 0.25 * rate else nan


def advice(found: Roughness, name: str, amount: str, rows: list[int], word: str) -> str:
    """Return the fault of a column and its remedy in words, for a message.

    `amount` is the noise with its unit, `rows` are the numbers of its rows, each a `word`.
    """
    if found.jumps:
        at = ", ".join(str(rows[i]) for i in found.jumps[:3])
        more = f" and {len(found.jumps) - 3} more" if len(found.jumps) > 3 else ""
        return (
            f"jumps between two rows, at {word} {at}{more}, which a smooth curve cannot follow; "
            "split the table there into pieces, between which a program jumps, or record it faster"
        )
    noise = f"the rows carry noise of {amount}, {100 * found.share:.2g} % of the largest value"
    if isfinite(found.cut_off):
        call = (
            f"scipy.signal.sosfiltfilt(scipy.signal.butter(4, {found.cut_off:.3g}, "
            f'fs={found.rate:.6g}, output="sos"), {name})'
        )
        return f"{noise}; smooth them first: {call}"
    call = f"scipy.interpolate.make_smoothing_spline(time, {name})(time)"
    return f"{noise}, or a motion with fewer than four rows to its period; record faster, or {call}"
