"""A change that peaks and troughs share, whatever its shape, as where a zero settles."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np

from stiction.analysis.signals.robust import part_means
from stiction.analysis.signals.straight_line import LASTING
from stiction.arrays import TINY, Floats

FEWEST = 4  # cycles that show such a change
MOST_MEANS = 20  # means of cycles: more would take long
LASTS = LASTING[::2]  # correlations of neighbours that are tried
# Changes over a record that are tried, over the scatter of the forces that show them: each factor
# is as likely. Two of three records are taken to have none. Where the zero is steady, the errors of
# friction then grow by a tenth with 12 to 80 slips, by a third with 6 to 14
SIZES = np.concatenate([[0.0], np.geomspace(0.1, 100.0, 9)])
NONE, WANDERS = 0.65, 0.2
FASTEST, SLOWEST, SETTLINGS = 0.05, 1.0, 4  # times in which it settles, over that of the record


class _Shifts(NamedTuple):
    """Mean squares of shifts of a mean by changes of the zero, and logarithms of likelihoods.

    Both are of shape (correlations, shapes, sizes).
    """

    square: Floats
    likely: Floats


def shared_change(begin: float, at: Floats, peak: Floats, trough: Floats) -> float:
    """Return by how much the zero shifts the mean of peaks, or of troughs, N: a root mean square.

    The zero is right at the `begin` of a record (s). From there on it does not change, or settles
    exponentially, or wanders at random; and friction may be alike in neighbouring slips. The mean
    is over all of these, each as likely as it makes the forces (n,) of cycles at times `at` (s), by
    the restricted likelihood as in
    `stiction.analysis.signals.straight_line.slope_in_lasting_noise`. The drop from peak to trough
    shows friction alone: how alike neighbours are, and which part of the forces changes with it.
    A zero that has settled before the first peak leaves no trace.
    """
    if len(at) < FEWEST:
        return 0.0
    at, peak, trough = (part_means(each, MOST_MEANS) for each in (at, peak, trough))
    drop, forces = peak - trough, _without_friction(peak, trough)
    shapes = _shapes((at - begin) / (at[-1] - begin))
    found = _shifts(forces, shapes, SIZES)
    likely = found.likely + _shifts(drop, shapes[:1], SIZES[:1]).likely + np.log(_prior())
    weights = np.exp(likely - likely.max())
    return sqrt(float(np.average(found.square, weights=weights)))


def _without_friction(peak: Floats, trough: Floats) -> Floats:
    """Return forces between peaks and troughs that do not change with the drop, from one to next.

    They are the peaks where all of these are alike, the middles where the mass swings about them.
    """
    steps, middle = np.diff(peak - trough), 0.5 * (peak + trough)
    share = float(steps @ np.diff(middle)) / max(float(steps @ steps), TINY)
    return np.asarray(middle - float(np.clip(share, -0.5, 0.5)) * (peak - trough))


def _shapes(way: Floats) -> Floats:
    """Return the covariances of changes by 1: of one that wanders, and of some that settle.

    `way` is the time since the beginning, 1 at the last cycle.
    """
    times = np.geomspace(max(FASTEST, way[0]), SLOWEST, SETTLINGS)[:, None]
    settled = 1.0 - np.exp(-way / times)
    return np.stack([np.minimum(way[:, None], way), *(settled[:, :, None] * settled[:, None])])


def _prior() -> Floats:
    """Return how likely each shape and size of a change is beforehand."""
    settles = (1.0 - NONE - WANDERS) / SETTLINGS
    shares = np.array([WANDERS, *[settles] * SETTLINGS])[:, None]
    sizes = len(SIZES) - 1.0
    return np.where(SIZES > 0.0, shares / sizes, NONE / len(shares))


def _shifts(values: Floats, shapes: Floats, sizes: Floats) -> _Shifts:
    """Return by how much changes of some shapes and sizes shift the mean of values (n,).

    For each correlation the noise is made independent, and the axes are those of the change. There
    the change has its share of what values deviate by from their level, whose error counts, too.
    """
    count = len(values)
    lag = np.abs(np.subtract.outer(np.arange(count), np.arange(count)))
    root = np.linalg.cholesky(LASTS[:, None, None] ** lag)[:, None]
    away = np.linalg.inv(root)
    strength, axes = np.linalg.eigh(away @ shapes @ away.swapaxes(-1, -2))
    along = axes.swapaxes(-1, -2) @ away
    one, value = along.sum(-1)[..., None, :], (along @ values)[..., None, :]
    of_mean = (axes.swapaxes(-1, -2) @ root.swapaxes(-1, -2)).mean(-1)[..., None, :]
    change = sizes[:, None] ** 2 * np.maximum(strength, 0.0)[..., None, :]
    total = (one**2 / (1.0 + change)).sum(-1)
    level = (one * value / (1.0 + change)).sum(-1) / total
    left = value - level[..., None] * one
    squares = np.maximum((left**2 / (1.0 + change)).sum(-1), TINY)
    share = of_mean * change / (1.0 + change)
    shift, by_level = (share * left).sum(-1), (share * one).sum(-1)
    variance = (share * of_mean).sum(-1) + by_level**2 / total
    freedom = count - 1.0
    scale = 2.0 * np.log(np.diagonal(root, axis1=-2, axis2=-1)).sum(-1)[..., None]
    likely = np.log1p(change).sum(-1) + scale + np.log(total) + freedom * np.log(squares)
    return _Shifts(shift**2 + variance * squares / freedom, -0.5 * likely)
