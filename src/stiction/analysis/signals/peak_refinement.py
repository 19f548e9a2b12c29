"""Turning points to a fraction of a sample, or to within the noise."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.signals.digitised import resolution
from stiction.analysis.signals.turning_points import TurningPoints
from stiction.arrays import Floats, Indices

LEAST_SLOPE = 1e-9  # a slope less than this part of the bend is none
LOPSIDED = 0.5  # of its readings beneath: so many more lie on one side of a top that falls suddenly
LEVEL = 1e-12  # of the largest value: less is neither slope nor bend, as of a force that is clipped


class Pieces(NamedTuple):
    """The samples of pieces of a signal, the piece of each, and where each piece begins in them."""

    at: Indices
    piece: Indices
    begins: Indices

    @classmethod
    def between(cls, first: Indices, last: Indices) -> Pieces:
        """Return the pieces from one sample to another (included); they may overlap."""
        counts = last - first + 1
        begins = np.cumsum(counts) - counts
        piece = np.repeat(np.arange(len(first)), counts)
        return cls(np.arange(len(piece)) - begins[piece] + first[piece], piece, begins)

    def first(self, which: NDArray[np.bool_]) -> Indices:
        """Return the first sample of each piece that is among some (n,); there is one."""
        where = np.where(which, self.at, np.iinfo(np.intp).max)
        return np.asarray(np.minimum.reduceat(where, self.begins))

    def last(self, which: NDArray[np.bool_]) -> Indices:
        """Return the last sample of each piece that is among some (n,); -1 if none is."""
        return np.asarray(np.maximum.reduceat(np.where(which, self.at, -1), self.begins))


class Fits(NamedTuple):
    """Polynomials c_0 + c_1 x + ... in x = (t - middle)/half, which is -1 to 1 over each piece."""

    coefficients: Floats  # (pieces, degree + 1), in the unit of the values
    # (pieces,), in the unit of the time
    middle: Floats
    half: Floats

    def at(self, x: Floats) -> Floats:
        """Return each polynomial's value at its x."""
        powers = x[:, None] ** np.arange(self.coefficients.shape[1])
        values: Floats = (self.coefficients * powers).sum(axis=1)
        return values


def fit_pieces(time: Floats, values: Floats, first: Indices, last: Indices, degree: int) -> Fits:
    """Fit by least squares to the samples `first` to `last` (included) of each piece.

    Each piece has more samples than the degree; pieces may overlap.
    """
    at, piece, begins = Pieces.between(first, last)
    middle, half = 0.5 * (time[last] + time[first]), 0.5 * (time[last] - time[first])
    x = (time[at] - middle[piece]) / half[piece]
    y = values[at]
    moments = [np.add.reduceat(x**power, begins) for power in range(2 * degree + 1)]
    sums = [np.add.reduceat(y * x**power, begins) for power in range(degree + 1)]
    rows = np.arange(degree + 1)
    normal = np.stack(moments, axis=1)[:, rows[:, None] + rows]
    right = np.stack(sums, axis=1)[:, :, None]
    return Fits(np.linalg.solve(normal, right)[:, :, 0], middle, half)


class Vertices(NamedTuple):
    """Time and value of each turning point, (n,) each."""

    time: Floats
    value: Floats


def vertices(time: Floats, points: TurningPoints) -> Vertices:
    """Refine turning points by a parabola through all samples that may be the top under noise.

    These reach from the first sample, on the way up, that is within the noise of the top to the
    last one on the way down; where they are less than three, they are the top and its two
    neighbours. The parabola's vertex is kept among them: at a corner, where a slow rise ends in a
    fall, it lies where the fall begins.

    There are at least two points.
    """
    values = points.values
    time = time[: len(values) * points.width].reshape(len(values), -1).mean(axis=1)
    upward = np.where(points.trough, -1.0, 1.0)  # each point is a top of `upward * values`
    first, last = _within_noise(points, upward)
    fit = fit_pieces(time, values, first, last, 2)
    slope, bend = upward * fit.coefficients[:, 1], upward * fit.coefficients[:, 2]
    level = np.abs(slope) + np.abs(bend) < LEVEL * np.abs(values).max()
    x = np.where(level, 0.0, _top(slope, bend))
    found = Vertices(fit.middle + fit.half * x, fit.at(x))
    found = _corners_as_sampled(time, values, upward, first, last, found)
    return _in_order(time, points, _within_steps(time, points, upward, found))


def _top(slope: Floats, bend: Floats) -> Floats:
    """Return where slope x + bend x^2 is highest within -1 to 1, and 0 where it is at both ends."""
    with np.errstate(divide="ignore", invalid="ignore"):
        vertex = np.clip(-0.5 * slope / bend, -1.0, 1.0)
    tilted = np.abs(slope) > LEAST_SLOPE * np.abs(bend)
    return np.where(bend < 0.0, vertex, np.where(tilted, np.sign(slope), 0.0))


def _within_noise(points: TurningPoints, upward: Floats) -> tuple[Indices, Indices]:
    """Return first and last sample of each top; of less than three, also both neighbours."""
    index, n = points.index, len(points.values)
    first, last = _as_high(points, upward, points.noise)
    few = last - first < 2  # else the neighbour beyond a sudden fall is not a part of the top
    first = np.where(few, np.minimum(first, np.clip(index - 1, 0, n - 3)), first)
    return first, np.where(few, np.maximum(last, np.clip(index + 1, 2, n - 1)), last)


def _as_high(
    points: TurningPoints, upward: Floats, depth: float, away: int = 1
) -> tuple[Indices, Indices]:
    """Return first and last sample about each top, on both legs, that is at most so far below.

    The legs before the first point and after the last are looked at as far as another one: that of
    the next point `away`, which is like them if it is 2.
    """
    index, values, n = points.index, points.values, len(points.values)
    enough = values[index] - upward * depth
    legs = np.diff(index)
    away = min(away, len(legs))
    before, after = max(0, index[0] - legs[away - 1]), min(n - 1, index[-1] + legs[-away])
    ends = np.concatenate([[before], index, [after]])
    leg = np.repeat(np.arange(len(index) + 1), np.diff(ends))
    at = np.arange(before, after)
    on_top = [
        sign * values[at] >= sign * level
        for sign, level in (
            (np.append(upward, upward[-1])[leg], np.append(enough, enough[-1])[leg]),
            (np.append(upward[0], upward)[leg], np.append(enough[0], enough)[leg]),
        )
    ]
    starts = ends[:-1] - before
    first = np.minimum(np.minimum.reduceat(np.where(on_top[0], at, n), starts)[:-1], index)
    last = np.maximum.reduceat(np.where(on_top[1], at, -1), starts)[1:]
    return first, last


def _within_steps(time: Floats, points: TurningPoints, upward: Floats, found: Vertices) -> Vertices:
    """Place each top of equal readings of a converter by the next readings beneath it.

    It divides its readings in time as it divides those, into a way up and a way down: a smooth top
    lies in their middle, and one of a slow rise and a sudden fall at their end.
    """
    index, values = points.index, points.values
    level = values[index] == values[np.minimum(index + 1, len(values) - 1)]
    step = resolution(values) if points.width == 1 and level.any() else 0.0
    if points.noise >= step:
        return found
    (first, last), (low, high) = (_as_high(points, upward, k * step, 2) for k in (0.5, 1.5))
    rise, fall = time[first] - time[low], time[high] - time[last]
    both = rise + fall
    share = np.where(both > 0.0, rise, 0.5) / np.where(both > 0.0, both, 1.0)
    placed = time[first] + share * (time[last] - time[first])
    lopsided = abs(rise - fall) > LOPSIDED * both  # else the parabola's is better
    return Vertices(np.where((last > first) & lopsided, placed, found.time), found.value)


def _corners_as_sampled(
    time: Floats, values: Floats, upward: Floats, first: Indices, last: Indices, found: Vertices
) -> Vertices:
    """Leave a top of three samples as it is where it is a corner: no parabola goes through it.

    It is a corner if it bends more than twice as much as next to it, on either side.
    """
    middle = first + 1
    before, here, after = (
        -upward * _bend(time, values, np.clip(middle + k, 1, len(values) - 2)) for k in (-1, 0, 1)
    )
    corner = (last - first == 2) & (here > 2.0 * np.maximum(before, after))
    return Vertices(
        np.where(corner, time[middle], found.time), np.where(corner, values[middle], found.value)
    )


def _in_order(time: Floats, points: TurningPoints, found: Vertices) -> Vertices:
    """Leave tops as they are sampled where one and the next, a sample or two on, change places."""
    while (late := np.diff(found.time) <= 0.0).any():
        both = np.append(late, False) | np.insert(late, 0, False)
        its = time[points.index], points.values[points.index]
        found = Vertices(*(np.where(both, new, old) for new, old in zip(its, found, strict=True)))
    return found


def _bend(time: Floats, values: Floats, middle: Indices) -> Floats:
    """Return the second derivative from three samples."""
    (t0, t1, t2), (v0, v1, v2) = ([x[middle + k] for k in (-1, 0, 1)] for x in (time, values))
    bend: Floats = 2.0 * ((v2 - v1) / (t2 - t1) - (v1 - v0) / (t1 - t0)) / (t2 - t0)
    return bend
