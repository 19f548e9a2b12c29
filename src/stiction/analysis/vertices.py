"""Turning points to a fraction of a sample, or to within the noise."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.pieces import fitted
from stiction.analysis.turning_points import TurningPoints

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


class Vertices(NamedTuple):
    """Time and value of each turning point, (n,) each."""

    time: Floats
    value: Floats


def vertices(time: Floats, points: TurningPoints) -> Vertices:
    """Place turning points by a parabola through all samples that noise could have made the top.

    These reach from the first sample, on the way up, that is within the noise of the top to the
    last one on the way down; where there is no noise they are the top and its two neighbours.
    The parabola's vertex is kept among them: at a corner, where a slow rise ends in a fall, it
    lies where the fall begins.

    Parameters
    ----------
    time : array
        (n,), of each sample of the signal.
    points : TurningPoints
        At least two.
    """
    values = points.values
    time = time[: len(values) * points.width].reshape(len(values), -1).mean(axis=1)
    upward = np.where(points.trough, -1.0, 1.0)  # each point is a top of `upward * values`
    first, last = _within_noise(points, upward)
    fit = fitted(time, values, first, last, 2)
    _, slope, curvature = fit.coefficients.T
    with np.errstate(divide="ignore", invalid="ignore"):
        inside = np.nan_to_num(np.clip(-0.5 * slope / curvature, -1.0, 1.0))
    tries = np.stack([-np.ones_like(slope), inside, np.ones_like(slope)])
    heights = np.stack([upward * fit.at(x) for x in tries])
    best = np.argmax(heights, axis=0)
    each = np.arange(len(best))
    found = Vertices(fit.middle + fit.half * tries[best, each], upward * heights[best, each])
    return _corners_as_sampled(time, values, upward, first, last, found)


def _within_noise(points: TurningPoints, upward: Floats) -> tuple[Indices, Indices]:
    """Return first and last sample of each top; at least its sample and both neighbours."""
    index, values, n = points.index, points.values, len(points.values)
    enough = values[index] - upward * points.noise
    # the legs before the first point and after the last are looked at as far as the next ones
    before = max(0, 2 * index[0] - index[1])
    after = min(n - 1, 2 * index[-1] - index[-2])
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
    first = np.minimum.reduceat(np.where(on_top[0], at, n), starts)[:-1]
    last = np.maximum.reduceat(np.where(on_top[1], at, -1), starts)[1:]
    first = np.minimum(first, np.clip(index - 1, 0, n - 3))
    return first, np.maximum(last, np.clip(index + 1, 2, n - 1))


def _corners_as_sampled(
    time: Floats, values: Floats, upward: Floats, first: Indices, last: Indices, found: Vertices
) -> Vertices:
    """Leave a top of three samples as it is where it is a corner: no parabola goes through it.

    It is a corner if it bends more than twice as much as next to it, on either side.
    """
    middle = first + 1
    bend = np.stack(
        [
            -upward * (values[i + 1] - 2.0 * values[i] + values[i - 1])
            for i in (np.clip(middle + k, 1, len(values) - 2) for k in (-1, 0, 1))
        ]
    )
    corner = (last - first == 2) & (bend[1] > 2.0 * np.maximum(bend[0], bend[2]))
    return Vertices(
        np.where(corner, time[middle], found.time), np.where(corner, values[middle], found.value)
    )
