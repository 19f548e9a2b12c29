"""Load and drive in stick phases: creep at another load, loads that change, drives that pause."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.creep.curve import integral
from stiction.analysis.creep.loading_curve import BEFORE_SLIP
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import ERRORS_997
from stiction.arrays import TINY, Floats, xr
from stiction.errors import ResultError
from stiction.recording.noise import white_noise
from stiction.text.quantity.wording import percent
from stiction.trajectory import Trajectory

# Of a stick phase, over each of which the load is averaged: their changes are its own
PARTS_OF_PHASE = 16
# Largest change of the load in a stick phase, as a share of it: for the exponent of the divergence,
# and a misalignment by the force alone; for one by creep; and that times (k_x/k_y)/tan^2(phi), as a
# softer spring across turns the slip with friction. Found on random rigs under ramps and
# oscillations: with twice as much, one in ten values is more than three errors off
CHANGED, FOLLOWED, TURNED = 0.25, 0.4, 0.2
# Of the drive's velocity: a stick phase in which its mean differs by more has a pause in it, or is
# of another velocity. Creep differs by as much. In a run, whose drive is known, by less
PAUSED, KNOWN = 0.1, 0.02
NOISE = 4.3  # standard deviations of a sample: three of a difference of two
# Fewer rises are not compared; the quantile of their beginnings, from which up to `BEFORE_SLIP`
# there are so many levels
FEWEST_RISES, LOWER, LEVELS = 4, 0.8, 10
# Of a bin: sticks of the transverse oscillation take less than a rest does; and of the velocity
# in the next bin, which by Eq. (7) is 1.1 to 1.2 times as large: less is partly rest
PARTLY, MOSTLY = 0.25, 0.88
OTHERS = 0.1  # of the phases: where more are at rest in a bin, others may be so in parts of it


def at_one_load(curves: xr.Dataset, record: Record) -> xr.Dataset:
    """Return creep curves whose force is that at the load `normal_load` instead of a measured one.

    Friction is proportional to the load, and the slip follows the direction of friction: by Eq. (7)
    the velocity depends on the force over the load.
    """
    time = curves["slip_time"] - 0.5 * (curves["begin"] + curves["end"])
    load = np.interp(time.values, record.time, record.relative_load())
    return curves.assign(force=curves["force"] / load)


def after_rest(curves: xr.Dataset, source: Trajectory | Record) -> xr.Dataset:
    """Return creep curves without the bins in which the mass rests before it creeps, or begins to.

    After a slip it rests until the springs reach friction again, and not equally long in each
    phase: means of rest and creep are neither. The rests of a run are known. A record shows them by
    a velocity below most of that in the next bin nearer to slip; one without a position does not,
    as its creep is counted from where it is slowest.
    """
    if isinstance(source, Trajectory):
        slow = _partly_at_rest(curves, source.stick_intervals)
    elif source.position is not None:
        slow = _slower_than_next(curves)
    else:
        return curves
    seen = np.isfinite(curves["velocity"].values)
    before = np.logical_and.accumulate((slow | ~seen)[:, ::-1], axis=1)[:, ::-1]
    before[before.all(axis=1)] = False  # the mass rests throughout, or goes by jerks
    mixed = (before & seen).sum(axis=0) > OTHERS * seen.sum(axis=0)
    before |= mixed
    return curves.where(xr.DataArray(~before, dims=("phase", "bin")))


def _partly_at_rest(curves: xr.Dataset, sticks: Floats) -> NDArray[np.bool_]:
    """Return in which bins one rest, (n, 2), s, takes a considerable part."""
    begin, end = (curves["slip_time"].values[:, None] - curves[x].values for x in ("begin", "end"))
    if not len(sticks):
        return np.zeros(begin.shape, bool)
    start, stop = sticks.T
    longest = np.zeros(begin.shape)
    for at in (begin, end, 0.5 * (begin + end)):  # a rest of a quarter of a bin or more covers one
        its = np.searchsorted(stop, at).clip(max=len(stop) - 1)
        longest = np.fmax(longest, np.minimum(stop[its], end) - np.maximum(start[its], begin))
    return np.asarray(longest > PARTLY * (end - begin))


def _slower_than_next(curves: xr.Dataset) -> NDArray[np.bool_]:
    """Return in which bins creep is slower for sure than most of that in the next one."""
    velocity, error = curves["velocity"].values, np.nan_to_num(curves["velocity_error"].values)
    nearer, its = np.full(velocity.shape, np.nan), np.zeros(velocity.shape)
    nearer[:, 1:], its[:, 1:] = velocity[:, :-1], error[:, :-1]
    return np.asarray(velocity + ERRORS_997 * np.hypot(error, its) < MOSTLY * nearer)


def driven_steadily(record: Record, begin: Floats, end: Floats) -> NDArray[np.bool_]:
    """Return in which stick phases the drive goes on at its velocity, (n,).

    `begin` and `end` (s) are those of the phases. The drive is that of the run, that which was
    measured, either way, or that which loads the spring, X + F/k_x. Of a force alone pauses are
    seen.
    """
    if not len(begin) or (record.slider is not None and record.drive_travel is None):
        return np.ones(len(begin), bool)
    known, way = _velocity_and_way(record)
    if way is None:
        return ~_pauses(record, begin, end)
    lasts = end - begin
    passed = np.abs(np.diff(np.interp([begin, end], record.time, way), axis=0)[0])
    speeds = passed / np.maximum(lasts, TINY)
    usual = lasts * (known or np.quantile(speeds, 0.5, method="higher"))  # a pause makes it less
    most = KNOWN * usual if record.slider is not None else PAUSED * usual + NOISE * white_noise(way)
    return np.asarray(np.abs(passed - usual) <= most)


def shows_drive(record: Record) -> bool:
    """Return whether a record shows its drive, not only a force that hesitates as with a pause."""
    return record.slider is not None or _velocity_and_way(record)[1] is not None


def _velocity_and_way(record: Record) -> tuple[float | None, Floats | None]:
    """Return the intended velocity of a drive (m/s), and its displacement, (n,), m."""
    ways = record.drive_travel, record.drive_position
    way = next((each for each in ways if each is not None), None)
    if way is None and record.position is not None and record.stiffness is not None:
        return None, record.position + record.force / record.stiffness
    return record.drive_velocity, way


def _pauses(record: Record, begin: Floats, end: Floats) -> NDArray[np.bool_]:
    """Return in which rises the force stays for longer than in most others, but for the peak, (n,).

    Creep has no memory: as long as the drive goes on, a force takes as long to rise from one level
    to the next in each rise. Levels are shares of the peak, and times go with it: under another
    load both are in proportion.
    """
    none = np.zeros(len(begin), bool)
    inside = [slice(*each) for each in np.searchsorted(record.time, [begin, end]).T]
    sizes = [each.stop - each.start for each in inside]
    if len(inside) < FEWEST_RISES or min(sizes) < 2:
        return none
    step = float((end - begin).sum()) / sum(sizes)  # a slip can have a million times the rate
    rises = [_evenly(record.time[each], record.force[each], step) for each in inside]
    peaks = np.array([each.max() for each in rises])
    high = float(np.median(peaks))
    if not peaks.min() > 0.0:
        return none
    scales = high / peaks
    scaled = [each * scale for each, scale in zip(rises, scales, strict=True)]
    low = float(np.quantile([each[0] for each in scaled], LOWER))
    levels = np.linspace(low, high - BEFORE_SLIP * (high - low), LEVELS + 1)
    if not np.diff(levels).min() > 0.0:
        return none
    stays = np.array([np.histogram(each, levels)[0] for each in scaled]) * scales[:, None]
    usual = np.median(stays, axis=0)
    noise = NOISE * white_noise(record.force) / (levels[1] - levels[0]) * usual
    most = PAUSED * float(np.median([*map(len, rises)])) + noise
    return np.asarray((stays - usual > most).any(axis=1))


def _evenly(time: Floats, values: Floats, step: float) -> Floats:
    """Return values so often as they last: at times a `step` (s) apart, straight in gaps."""
    return np.interp(np.arange(time[0], time[-1] + 0.5 * step, step), time, values)


def load_change(record: Record, begin: Floats, end: Floats) -> float:
    """Return how far the load goes up and down, over its mean, in the stick phase of most change.

    `begin` and `end` (s) are those of the phases. Readings without load count as neighbours do; 0
    where the load's noise may be all of its variation.
    """
    time, load = _load_readings(record)
    if len(time) < 2 or not record.load_variation() > 0.0:
        return 0.0
    edges = np.linspace(begin, end, PARTS_OF_PHASE + 1)
    areas = integral(time, load, np.clip(edges, time[0], time[-1]))
    means = np.diff(areas, axis=0) / np.diff(edges, axis=0)
    changes = np.abs(np.diff(means, axis=0)).sum(axis=0) / means.mean(axis=0)
    return float(np.fmax.reduce(changes, initial=0.0))


def typical_load(record: Record, times: Floats) -> float:
    """Return the median of the load over `normal_load` at some times (s).

    Readings without load count as neighbours do.
    """
    return float(np.median(np.interp(times, *_load_readings(record))))


def _load_readings(record: Record) -> tuple[Floats, Floats]:
    """Return the times (s) at which there is a load, and that over `normal_load`."""
    load = record.relative_load()
    its = np.isfinite(load)
    return record.time[its], load[its]


def refuse_change(change: float, most: float, why: str) -> None:
    """Refuse a finding under a load that changes by more than a share `most`."""
    if change > most:
        raise ResultError(
            f"not determined: the normal load changes by {percent(change)} in a stick phase, {why}"
        )
