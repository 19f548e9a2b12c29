"""A recorded quantity between its rows: a cubic spline, its travel, and exact bounds.

The value is a cubic between two rows (M78), of which the solver takes none in the middle of a step:
its steps end at the rows. The plain functions here work on floats, on arrays of times, and in
compiled code, for which `piece_at_one` takes the place of `piece_at`.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from math import inf
from typing import Any, NamedTuple

import numpy as np

from stiction.arrays import Floats
from stiction.drive.signal import Signal, change_at, curve_at, sum_over, value_at
from stiction.text.samples import FrozenColumn

KEPT = 8  # splines of tables, while their programs are made again with other parameters


class Recording(NamedTuple):
    """A recorded velocity or load over one passage of its table, with a wave on top.

    Parameters
    ----------
    rows : ndarray
        (n + 1,), s: the times of the table's rows in the run.
    first : ndarray
        (b + 1,): for b parts of the time, of one length, the piece in which each begins; n - 1.
    per_part : float
        Parts per second.
    cubics : ndarray
        (n, 4): value and derivatives at the start of each piece, over 0! to 3!.
    sums : ndarray
        (n + 1,): the integral up to each row.
    bounds : ndarray
        (n, 5): least and largest value, then the largest magnitudes of the first three
        derivatives, in each piece.
    wave : Signal
        What is added.
    """

    rows: Any
    first: Any
    per_part: float
    cubics: Any
    sums: Any
    bounds: Any
    wave: Signal

    def value_at(self, t: Any) -> Any:
        """Return the value at time `t`."""
        i = piece_at(self, t)
        c, x = self.cubics, t - self.rows[i]
        found = c[i, 0] + x * (c[i, 1] + x * (c[i, 2] + x * c[i, 3]))
        return found + value_at(self.wave, t)

    def change_at(self, t: Any) -> Any:
        """Return the derivative at time `t`."""
        i = piece_at(self, t)
        c, x = self.cubics, t - self.rows[i]
        found = c[i, 1] + x * (2.0 * c[i, 2] + x * (3.0 * c[i, 3]))
        return found + change_at(self.wave, t)

    def curve_at(self, t: Any) -> Any:
        """Return the second derivative at time `t`."""
        i = piece_at(self, t)
        c = self.cubics
        return 2.0 * c[i, 2] + (t - self.rows[i]) * (6.0 * c[i, 3]) + curve_at(self.wave, t)

    def sum_over(self, t: Any, dt: Any) -> Any:
        """Return the integral from `t` to `t + dt`, without cancellation for short `dt`."""
        end = t + dt
        i, j = piece_at(self, t), piece_at(self, end)
        begun = cubic_sum(self, i, t - self.rows[i], np.minimum(dt, self.rows[i + 1] - t))
        rest = self.sums[j] - self.sums[i + 1] + cubic_sum(self, j, 0.0, end - self.rows[j])
        return begun + (j > i) * rest + sum_over(self.wave, t, dt)

    def bounds_between(self, start: float, end: float) -> tuple[float, float, float, float]:
        """Return bounds of the magnitudes of the value and its first three derivatives."""
        found = self.bounds[int(piece_at(self, start)) : int(piece_at(self, end)) + 1]
        most = np.column_stack([np.abs(found[:, :2]).max(axis=1), found[:, 2:]]).max(axis=0)
        wave = self.wave.bounds_between(start, end)
        return tuple(float(a) + b for a, b in zip(most, wave, strict=True))  # type: ignore[return-value]

    def bounds_at(self, rows: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Return such bounds between successive times, which include the recording's rows."""
        found = self.bounds[piece_at(self, rows[:-1])]
        wave = self.wave.bounds_between(float(rows[0]), float(rows[-1]))
        value = np.abs(found[:, :2]).max(axis=1) + wave[0]
        return value, found[:, 2] + wave[1], found[:, 3] + wave[2], found[:, 4] + wave[3]

    def fastest(self) -> float:
        """Return the largest angular frequency, rad/s: curvature over slope, as for a harmonic."""
        _, _, change, curve, _ = np.abs(self.bounds).max(axis=0)
        return max(self.wave.fastest(), float(curve / change) if change > 0.0 else 0.0)

    def may_vanish(self, start: float, end: float) -> Iterator[tuple[float, float]]:
        """Yield the intervals (s) in which the value may reach zero: some of the pieces."""
        least = self.bounds[:, 0] - self.wave.bounds_between(start, end)[0]
        first, last = int(piece_at(self, start)), int(piece_at(self, end))
        for i in (np.flatnonzero(least[first : last + 1] <= 0.0) + first).tolist():
            yield max(start, float(self.rows[i])), min(end, float(self.rows[i + 1]))


def piece_at(r: Recording, t: Any) -> Any:
    """Return the piece that holds at time `t`, the later one at a row."""
    return np.clip(np.searchsorted(r.rows, t, side="right") - 1, 0, len(r.cubics) - 1)


def piece_at_one(r: Recording, t: float) -> int:
    """Do as `piece_at` for one time, in compiled code: in the same time for any number of rows.

    A part of the time tells between which two pieces it is; rows at equal distances leave one or
    two.
    """
    part = (t - r.rows[0]) * r.per_part
    k = int(min(max(part, 0.0), len(r.first) - 2.0))
    low, high = r.first[k], r.first[k + 1]
    while low > 0 and t < r.rows[low]:  # the part was rounded
        low -= 1
    while high < len(r.cubics) - 1 and t >= r.rows[high + 1]:
        high += 1
    while low < high:
        middle = (low + high + 1) // 2
        if t >= r.rows[middle]:
            low = middle
        else:
            high = middle - 1
    return int(low)


def cubic_sum(r: Recording, i: Any, x: Any, dx: Any) -> Any:
    """Return the integral of a piece from `x` to `x + dx`, s from its start: Taylor's at `x`."""
    c = r.cubics
    value = c[i, 0] + x * (c[i, 1] + x * (c[i, 2] + x * c[i, 3]))
    change = c[i, 1] + x * (2.0 * c[i, 2] + x * (3.0 * c[i, 3]))
    curve = c[i, 2] + x * (3.0 * c[i, 3])
    return dx * (value + dx * (change / 2.0 + dx * (curve / 3.0 + dx * (c[i, 3] / 4.0))))


class Spline(NamedTuple):
    """The common part of one table's passages: a `Recording` from t = 0 on, no wave."""

    rows: Floats
    first: Any
    cubics: Floats
    sums: Floats
    bounds: Floats


@lru_cache(maxsize=KEPT)
def spline(
    time: FrozenColumn, values: FrozenColumn, integrated: bool, scale: float = 1.0
) -> Spline:
    """Return the spline through the rows of a table, its values times `scale`.

    If the values are `integrated`, it is that of its slope. Four rows fix its ends ("not-a-knot"):
    (M78).
    """
    import scipy.interpolate

    CubicSpline: Any = scipy.interpolate.CubicSpline  # its stubs are missing
    rows = time.values - time.values[0]
    through = CubicSpline(rows, values.values, bc_type="not-a-knot")
    if integrated:
        through = through.derivative()
    cubics = np.zeros((len(rows) - 1, 4))
    for power, column in enumerate(reversed(through.c)):
        cubics[:, power] = scale * column
    lengths = np.diff(rows)
    sums = np.concatenate([[0.0], np.cumsum(lengths * _mean(cubics, lengths))])
    starts = np.linspace(0.0, rows[-1], len(rows))
    first = np.clip(np.searchsorted(rows, starts, side="right") - 1, 0, len(cubics) - 1)
    return Spline(rows, first.astype(np.int64), cubics, sums, extremes(cubics, lengths))


def _mean(cubics: Floats, lengths: Floats) -> Floats:
    """Return the mean of each piece over its length."""
    a, b, c, d = cubics.T
    found: Floats = a + lengths * (b / 2.0 + lengths * (c / 3.0 + lengths * (d / 4.0)))
    return found


def extremes(cubics: Floats, lengths: Floats) -> Floats:
    """Return the bounds of each piece (M79), as `Recording` has them; they are attained."""
    a, b, c, d = cubics.T
    zero = np.zeros_like(a)
    with np.errstate(divide="ignore", invalid="ignore"):
        # zeros of b + 2 c x + 3 d x^2 without cancellation, and of 2 c + 6 d x
        q = -(c + np.copysign(np.sqrt(c * c - 3.0 * b * d), c))
        turns = np.stack([zero, lengths, q / (3.0 * d), b / q])
        slopes = np.stack([zero, lengths, -c / (3.0 * d)])
    x, y = (np.clip(np.where(np.isfinite(at), at, 0.0), 0.0, lengths) for at in (turns, slopes))
    values = a + x * (b + x * (c + x * d))
    changes = np.abs(b + y * (2.0 * c + y * (3.0 * d)))
    curves = np.maximum(np.abs(2.0 * c), np.abs(2.0 * c + 6.0 * d * lengths))
    return np.stack(
        [values.min(axis=0), values.max(axis=0), changes.max(axis=0), curves, np.abs(6.0 * d)],
        axis=1,
    )


def recording(made: Spline, start: float) -> Recording:
    """Return the passage of a table from `start` (s) on."""
    rows = start + made.rows
    per_part = len(made.cubics) / float(rows[-1] - rows[0])
    still = Signal(start, 0.0)
    return Recording(rows, made.first, per_part, made.cubics, made.sums, made.bounds, still)


def silent(wave: Signal) -> Recording:
    """Return a recording of nothing, for ever, with a wave on top."""
    return Recording(
        np.array([0.0, inf]),
        np.zeros(2, dtype=np.int64),
        0.0,
        np.zeros((1, 4)),
        np.zeros(2),
        np.zeros((1, 5)),
        wave,
    )
