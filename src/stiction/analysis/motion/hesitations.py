"""The distinction between cycles of a force and hesitations within one.

Before a slip, or within it, the mass can hesitate: the force dips, rises again, and then falls.
Such a reversal belongs to its cycle. Its height distinguishes it: a cycle is a fall of at least
half the swing. Irregular stick-slip with slips of every size is the exception: if falls differ so
much that their number depends on the share of the swing that is asked for, and small ones are a
minority, only a fall far below the others is a hesitation.

Where the force moves slowly beside the cycles, as over each turn of a disc, the swing up and the
swing down differ; that motion is subtracted first.

A few falls far above all others, as of a knock or of a rare slip in a vibration, are cycles among
the others, and no measure of them. But if the force rises between them as far as they fall, they
are the slips, and the others hesitate.

Only reversals that stand apart from noise and ripple are considered: in a measured force those
above about 5 % of a drop, 10 % under noise.

`stiction.analysis.motion.cycles`, audits and studies all count cycles with this module.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.analysis.signals.reversals import smallest_legs
from stiction.arrays import TINY, Floats, Indices

# Times the largest of the other falls, and one in so many: such a fall says nothing of the others.
# `stand_apart` compares cycles with their median; that of reversals depends on noise and samples
FAR_ABOVE, RARE = 3.0, 20
HALF = 0.5  # of the swing: a larger fall is a cycle
ABOUT_HALF = (0.4, 0.6)  # of the swing: without a fall between these, half divides them clearly
LEAST_FALL = 0.1  # of the swing: a smaller fall is a hesitation in any case
AROUND = 12  # neighbours on each side for comparison: amplitudes may grow or shrink
# Times as many as falls: so many reversals come with the falls and belong to them. Those below
# LEAST_FALL do not count, as how many of them are seen depends on noise and samples.
OFTEN = 1.1
FEW_FALLS = 5  # falls: whether fewer are alike is not known
# Falls spread evenly from half the swing to the whole of it have a standard deviation of 0.19 of
# their mean; twice the standard error of that, 1/(2 n)^(1/2), is added.
ALIKE_FALLS = 0.23
# Legs, two cycles, over which a slow motion goes on and before which it went on, and by how much at
# least, in swings: no hesitating cycle moves by so much to the same side twice
AWAY, GOES_ON = 4, 0.5
# A loading leads to them if the peaks rise by so much of their heights in all, as estimated from so
# many equal parts for each of them, by the median part
LOADED, PIECES = 0.25, 6


class Hesitations(NamedTuple):
    """Reversals taken out of a sequence of turning points, and the remaining points.

    Parameters
    ----------
    kept : ndarray
        (n,) indices of the remaining points, the ends of the cycles' rises and falls.
    at : ndarray
        (m,) index of the first point of each reversal taken out, in order.
    depth : ndarray
        (m,) its height, in the unit of the values.
    """

    kept: Indices
    at: Indices
    depth: Floats


def cycle_corners(
    value: Floats, time: Floats, ends: tuple[float, float], trough: bool
) -> Hesitations:
    """Remove the hesitations from peaks and troughs; a trough stays first and last.

    The `ends` are extremes before and after them, as for `remove_hesitations`, N; `trough` says
    whether the first is a trough.
    """
    values = np.concatenate([ends[:1], value, ends[1:]])
    found = remove_hesitations(level(values, time))
    kept = found.kept - 1  # of which the first was before
    kept = kept[0 if len(kept) and (kept[0] % 2 == 0) == trough else 1 :]
    kept = kept[: (len(kept) - 1) // 2 * 2 + 1]
    return Hesitations(kept, found.at - 1, found.depth)


def remove_hesitations(values: Floats) -> Hesitations:
    """Remove the hesitations from a sequence of turning points.

    Peaks and troughs alternate. The first and last value are extremes before and after them, lower
    bounds of the movements that the record cuts.
    """
    most = largest_leg(values)
    found = _below(values, HALF, most)
    change = np.diff(values[found.kept])
    fall = -change[change < 0.0]
    if len(found.kept) == len(values) - 2 or _alike(np.minimum(fall, most)):
        return found  # of what has no reversal below half the swing none is below less
    shallow = _below(values, LEAST_FALL, most)
    deep = (len(shallow.kept) - len(found.kept)) // 2
    return found if deep >= OFTEN * len(fall) > 0 or _is_divided(values, most) else shallow


def largest_leg(values: Floats) -> float:
    """Return the size above which a leg is not typical; infinity if all legs are.

    Legs are not typical if a few falls, or rises, are far above all others, `FAR_ABOVE` times the
    largest of these, unless a loading leads to these falls.
    """
    change = np.diff(values[1:-1])
    few = len(change) // (2 * RARE)
    if few == 0:
        return np.inf
    falls, rises = np.maximum(-change, 0.0), np.maximum(change, 0.0)
    usual = [float(np.partition(size, -few - 1)[-few - 1]) for size in (falls, rises)]
    far = FAR_ABOVE * np.array(usual)
    if not (falls.max() > far[0] or rises.max() > far[1]):
        return np.inf
    fall = np.append(np.where(falls > far[0], falls, 0.0), 0.0)
    return np.inf if fall.any() and _is_loaded(values[1:-1], fall) else min(usual)


def _is_loaded(values: Floats, fall: Floats) -> bool:
    """Return whether a force rises most of the time, and falls as much in a few falls.

    `fall` is the height of such a fall from each of some peaks and troughs in turn, or 0.
    """
    passed = np.cumsum(fall) - fall
    peaks = (values + passed)[int(values[0] < values[1]) :: 2]
    places = np.linspace(0, len(peaks) - 1, PIECES * (np.count_nonzero(fall) + 1) + 1)
    rises = np.diff(np.interp(places, np.arange(len(peaks)), peaks))
    return float(np.median(rises)) * len(rises) > LOADED * float(fall.sum())


def level(values: Floats, time: Floats) -> Floats:
    """Subtract a slow motion beside the cycles from a sequence of turning points.

    Parameters
    ----------
    values : ndarray
        (n,) alternating peaks and troughs between two extremes, as for `remove_hesitations`.
    time : ndarray
        (n - 2,) times of the peaks and troughs.
    """
    inner, last = values[1:-1], len(values) - 3
    if last < 2 * AWAY:
        return values
    size = typical(np.minimum(np.abs(np.diff(inner)), largest_leg(values)))
    middle = np.clip(np.arange(last + 1), AWAY, last - AWAY)
    before, after = inner[middle] - inner[middle - AWAY], inner[middle + AWAY] - inner[middle]
    moves = np.minimum(np.abs(before), np.abs(after)) * (before * after > 0.0)
    # a peak and a trough together: swings may grow to both sides
    goes_on = 0.5 * (moves[1:] + moves[:-1]) > GOES_ON * size
    if not goes_on.any():
        return values
    rate = (before + after) / np.maximum(time[middle + AWAY] - time[middle - AWAY], TINY)
    passed = np.where(goes_on, 0.5 * (rate[1:] + rate[:-1]) * np.diff(time), 0.0)
    slow = np.concatenate([[0.0, 0.0], np.cumsum(passed)])
    return np.asarray(values - np.append(slow, slow[-1]))


def _below(values: Floats, share: float, most: float = np.inf) -> Hesitations:
    """Take out reversals below a share of the swing, the smallest first.

    Legs that are larger than `most` count as no more in what is typical.
    """
    points, legs = np.arange(len(values)), np.abs(np.diff(values))
    size = swing(legs, most)
    at, depth = [np.zeros(0, np.intp)], [np.zeros(0)]
    while len(points) > 4:
        found = smallest_legs(legs, share * size[1:-1])
        if not len(found):
            break
        at.append(points[found])
        depth.append(legs[found])
        gone = np.concatenate([found, found + 1])
        points, size = np.delete(points, gone), np.delete(size, gone)
        legs = np.abs(np.diff(values[points]))
        joined = found - 1 - 2 * np.arange(len(found))
        size = _swing_beside(size, legs, joined, most)
    places = np.concatenate(at)
    order = np.argsort(places)
    return Hesitations(
        _whole(values, points, share, most), places[order], np.concatenate(depth)[order]
    )


def _is_divided(values: Floats, most: float) -> bool:
    """Return whether falls and reversals lie on either side of half the swing, none about it."""
    few, many = (len(_below(values, share, most).kept) for share in ABOUT_HALF)
    return few == many > 2 * FEW_FALLS


def _alike(fall: Floats) -> bool:
    """Return whether falls are of one size."""
    if len(fall) < FEW_FALLS:
        return False
    ratio = fall / typical(fall)
    spread = float(ratio.std() / ratio.mean())
    return bool(spread * (1.0 + (2.0 / len(fall)) ** 0.5) < ALIKE_FALLS)


def swing(legs: Floats, most: float = np.inf) -> Floats:
    """Return the typical size of legs in the same direction around each leg, `most` at most.

    Rises are compared with rises and falls with falls: where the force drifts they differ. The
    first leg and the last may be cut, and do not count.
    """
    found, legs = np.zeros(len(legs)), np.minimum(legs, most)
    for first in (1, 2):
        if len(legs) - 1 > first:
            found[first:-1:2] = typical(legs[first:-1:2])
    return found


def _swing_beside(size: Floats, legs: Floats, joined: Indices, most: float) -> Floats:
    """Return the `swing` of legs, some of which were joined from three, by the other legs' swing.

    Hesitations can go one beside the other along a whole record, some at a time: then all but a few
    keep their size.
    """
    count, reach = len(legs), 2 * AROUND
    if count <= (reach + 4) * (len(joined) + 2):
        return swing(legs, most)
    begin, end = (
        np.bincount(np.clip(joined + at, 0, count), minlength=count + 1)
        for at in (-reach, reach + 1)
    )
    beside = np.cumsum(begin - end) > 0
    legs = np.minimum(legs, most)
    for first in (1, 2):
        near = size[first:-1:2][AROUND:-AROUND]
        rows = np.flatnonzero(beside[first:-2:2][AROUND:-AROUND])
        near[rows] = _weighted_median(_around(legs[first:-1:2])[rows])
        size[first:-1:2] = _to_ends(near)
    return size


def typical(size: Floats) -> Floats:
    """Return the typical size around each leg: half of the total path is in larger ones."""
    if len(size) <= 2 * AROUND + 1:
        return np.full(len(size), _weighted_median(size[None, :])[0])
    return _to_ends(_weighted_median(_around(size)))


def _around(size: Floats) -> Floats:
    """Return rows of as many neighbours on either side of each that has them."""
    return np.lib.stride_tricks.sliding_window_view(size, 2 * AROUND + 1)


def _to_ends(near: Floats) -> Floats:
    """Return values for all places, from values at places with enough neighbours on both sides."""
    return np.concatenate([np.full(AROUND, near[0]), near, np.full(AROUND, near[-1])])


def _weighted_median(rows: Floats) -> Floats:
    """Return the median of each row, each value weighted by itself."""
    ordered = np.sort(rows, axis=1)
    passed = ordered.cumsum(axis=1)
    middle = (passed >= 0.5 * passed[:, -1:]).argmax(axis=1)
    return np.asarray(ordered[np.arange(len(rows)), middle])


def _whole(values: Floats, points: Indices, share: float, most: float) -> Indices:
    """Leave out the ends and cut hesitations: small legs before a large one."""
    inner = points[1:-1]
    for _ in range(2):
        legs = np.abs(np.diff(values[np.concatenate([points[:1], inner, points[-1:]])]))
        largest = np.maximum.accumulate(legs[1:-2])
        jump = largest < LEAST_FALL * legs[2:-1]
        if jump.any():
            jump &= largest < share * swing(legs, most)[1:-2]
        inner = inner[np.flatnonzero(jump)[-1] + 1 if jump.any() else 0 :]
        inner, points = inner[::-1], points[::-1]
    return inner
