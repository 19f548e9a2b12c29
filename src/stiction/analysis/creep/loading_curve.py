"""The mean loading curve of a stick-slip force: the distance crept at each force."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.analysis.record import Record, lacking_for_loading
from stiction.analysis.signals.digitised import rounding_of_mean
from stiction.arrays import Floats, xr
from stiction.errors import ResultError
from stiction.recording.noise import difference_gain

LEVELS = 40  # number of forces on the curve
FEWEST_BINS = 10  # bins in a rise, each of at least two samples
AFTER_TROUGH, BEFORE_SLIP = 0.1, 0.12  # of the drop, left out because inertia matters there


class LoadingCurve(NamedTuple):
    """The distance crept at each force, averaged over cycles.

    Parameters
    ----------
    force : ndarray
        (levels,), N; increasing.
    crept : ndarray
        (levels,), N: k_x times the distance crept, V t - F/k_x, with the stated stiffness, up to
        a constant.
    apart : ndarray
        (cycles, levels), N: deviation of each cycle from the mean, without its own constant.
    error : ndarray
        (levels,), N: standard error of the mean.
    peak, drop : float
        Largest force and fall of a typical cycle, N.
    """

    force: Floats
    crept: Floats
    apart: Floats
    error: Floats
    peak: float
    drop: float


def loading_curve(record: Record, cycles: xr.Dataset) -> LoadingCurve:
    """Average the loading of all cycles at equal forces.

    Quasistatic creep has no memory: its velocity depends on the force alone. Therefore cycles that
    begin at different forces can be averaged at equal ones. Each cycle's force is scaled by its
    peak, because the whole curve varies with the friction from cycle to cycle.
    """
    if not record.loading_rate:
        raise ResultError(
            "the rate at which the spring is loaded is not known: give the record its "
            f"{lacking_for_loading(record)}"
        )
    peak, drop = (float(np.median(cycles[name].values)) for name in ("peak", "drop"))
    begin = float(np.quantile(cycles["start_force"].values, 0.8))
    low, high = begin + AFTER_TROUGH * drop, peak - BEFORE_SLIP * drop
    if high <= 0.0:
        raise ResultError("not determined: the force is against the drive; its zero is off")
    if high <= low:
        raise ResultError(
            "not determined: the friction changes from cycle to cycle by as much as the force drops"
        )
    levels = np.linspace(low, high, LEVELS)
    rows = []
    columns = (cycles[name].values for name in ("start", "peak_time", "peak"))
    for start, top, most in zip(*columns, strict=True):
        row = _crept_forces(record, start, top, peak / most if peak > 0.0 else 1.0, levels)
        if row is not None:
            rows.append(row)
    if not rows:
        raise ResultError(
            f"no rise has {2 * FEWEST_BINS} samples between its trough and its peak; sample faster"
        )
    table = np.array(rows)
    table -= table.mean(axis=1, keepdims=True)
    middle = np.median(table, axis=0) if len(rows) >= 5 else table.mean(axis=0)
    apart = table - middle
    rounding = rounding_of_mean(record.force, (high - low) / LEVELS)
    error = np.hypot(_scatter(apart, rows), rounding)
    return LoadingCurve(levels, middle, apart, np.full(LEVELS, error), peak, drop)


def _crept_forces(
    record: Record, start: float, top: float, scale: float, levels: Floats
) -> Floats | None:
    """Return k_x times the distance crept at each force in one cycle; None if too coarse."""
    first, last = np.searchsorted(record.time, [start, top], side="left")
    count = min(LEVELS + 8, int(last - first) // 2)
    if count < FEWEST_BINS:
        return None
    edges = np.linspace(first, last, count + 1).astype(np.intp)
    size = np.diff(edges)
    time, force = (
        np.add.reduceat(each[:last], edges[:-1]) / size for each in (record.time, record.force)
    )
    force = scale * force
    order = np.argsort(force)
    if force[order[0]] > levels[0] or force[order[-1]] < levels[-1]:
        return None
    crept = scale * (record.loading_rate * (time - time[0])) - force
    return np.asarray(np.interp(levels, force[order], crept[order]))


def _scatter(apart: Floats, rows: list[Floats]) -> float:
    """Return the standard error of the mean from the scatter of cycles, or the noise of one."""
    count = len(rows)
    if count == 1:  # by mean squares: of 40 levels they tell more than the median of `white_noise`
        return float(
            np.std(np.diff(rows[0], 3)) / difference_gain(3) ** 0.5
        )  # that of white noise, less a cubic
    return float(np.sqrt((apart**2).sum(axis=0).mean() / (count - 1) / count))
